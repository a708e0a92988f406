#pragma once

#include <string_view>

namespace cambium::inline v0_1::detail {

/// Style sheet of the report page; light and dark differ in these variables only.
inline constexpr std::string_view report_style = R"css(
:root {
  color-scheme: light dark;
  --page: #f4f6f8; --panel: #ffffff; --line: #d9dfe5; --text: #16202b; --soft: #5b6a79; --accent: #1268d3;
  --stripe: #f8fafb; --box: #cfe0f6; --good: #1a8a45; --bad: #c9302c;
  --o0: #2f9e5b; --o1: #c9302c; --o2: #f08a7a; --o3: #e3a82b; --o4: #7d4fb5; --o5: #9aa5b1; --o6: #2a7fb8;
}
@media (prefers-color-scheme: dark) {
  :root {
    --page: #0f141a; --panel: #182029; --line: #2a3541; --text: #e8eef5; --soft: #93a3b3; --accent: #5aa9ff;
    --stripe: #1b242e; --box: #2a4466; --good: #4ec27f; --bad: #ff7a72;
    --o0: #37a566; --o1: #d9483f; --o2: #b5665c; --o3: #c9952a; --o4: #9168c9; --o5: #64717e; --o6: #4a9ad0;
  }
}
* { box-sizing: border-box; }
body {
  margin: 0; background: var(--page); color: var(--text);
  font: 14px/1.45 system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", sans-serif;
}
header, main { max-width: 1280px; margin: 0 auto; padding: 0 20px; }
header { padding-top: 22px; }
h1 { margin: 0; font-size: 24px; font-weight: 650; overflow-wrap: anywhere; }
h2 { margin: 0 0 4px; font-size: 18px; font-weight: 650; overflow-wrap: anywhere; }
h3 { margin: 20px 0 6px; font-size: 14px; font-weight: 650; overflow-wrap: anywhere; }
p { margin: 6px 0; } .soft, .note { color: var(--soft); } .note { font-size: 12.5px; }
nav { display: flex; flex-wrap: wrap; gap: 4px 14px; margin: 8px 0 0; }
a { color: var(--accent); }
section {
  margin: 16px 0; padding: 16px 18px; background: var(--panel); border: 1px solid var(--line); border-radius: 10px;
}
.verdict { border-left: 5px solid var(--good); font-weight: 550; overflow-wrap: anywhere; }
.verdict.loss { border-left-color: var(--bad); }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: 4px 10px; text-align: right; white-space: nowrap; border-bottom: 1px solid var(--line); }
th { font-weight: 600; color: var(--soft); font-size: 12.5px; white-space: normal; vertical-align: bottom; }
th:first-child, td:first-child, .left { text-align: left !important; }
td:first-child { font-weight: 550; }
tbody tr:nth-child(even) { background: var(--stripe); }
.ci { color: var(--soft); font-size: 12px; }
td.better { color: var(--good); font-weight: 650; } td.worse { color: var(--bad); font-weight: 650; }
.bars { display: grid; grid-template-columns: max-content minmax(160px, 1fr); gap: 5px 12px; align-items: center; }
.bars span { overflow: hidden; text-overflow: ellipsis; white-space: nowrap; max-width: 260px; }
.bars svg { width: 100%; height: 18px; border-radius: 4px; display: block; }
.legend { display: flex; flex-wrap: wrap; gap: 2px 14px; margin: 8px 0 0; font-size: 12.5px; color: var(--soft); }
.legend i, td i { display: inline-block; width: 10px; height: 10px; border-radius: 3px; margin-right: 6px; }
.plots { display: grid; grid-template-columns: repeat(auto-fill, minmax(380px, 1fr)); gap: 10px 22px; }
.plots svg { width: 100%; height: auto; display: block; } .plots h4 { margin: 8px 0 0; font-size: 13px; }
.plots text { fill: var(--soft); font-size: 11px; } .plots .name { fill: var(--text); font-size: 12px; }
.grid { stroke: var(--line); }
.dots { stroke: var(--accent); stroke-opacity: .28; stroke-width: 3; stroke-linecap: round; }
.box { fill: var(--box); stroke: var(--accent); } .whisker { stroke: var(--accent); fill: none; }
.median { stroke: var(--text); stroke-width: 2; }
details { margin-top: 12px; } summary { cursor: pointer; font-weight: 600; }
code, .mono { font: 12.5px/1.5 ui-monospace, Menlo, Consolas, "DejaVu Sans Mono", monospace; overflow-wrap: anywhere; }
.controls { display: flex; flex-wrap: wrap; gap: 8px; margin: 8px 0; align-items: center; }
input[type=search], select, button {
  height: 34px; padding: 0 10px; border: 1px solid var(--line); border-radius: 8px; background: var(--page);
  color: inherit; font: inherit; max-width: 100%;
}
button { cursor: pointer; } button:hover, select:hover { border-color: var(--accent); }
input[type=search] { flex: 1 1 200px; min-width: 140px; }
label { display: inline-flex; align-items: center; gap: 6px; cursor: pointer; }
:focus-visible { outline: 2px solid var(--accent); outline-offset: 1px; }
#runs th { cursor: pointer; user-select: none; white-space: nowrap; }
#runs th[aria-sort=ascending]::after { content: " ▲"; } #runs th[aria-sort=descending]::after { content: " ▼"; }
#runs tbody tr { cursor: pointer; }
#runs tbody tr:hover { background: color-mix(in srgb, var(--accent) 12%, transparent); }
#runs td { max-width: 320px; overflow: hidden; text-overflow: ellipsis; }
#runs .more td { white-space: normal; text-align: left; cursor: auto; font-weight: 400; max-width: none; }
.violation { display: block; font-size: 12px; overflow: hidden; text-overflow: ellipsis; }
.decisive { font-weight: 650; }
[hidden] { display: none !important; }
)css";

/// The list of runs: body and script. It reads the JSON of the element `data`.
inline constexpr std::string_view report_list = R"html(<section id="list"><h2>All runs</h2>
<p class="soft">A click on a row opens its replay, or says how to make it. A click on a head sorts. ❄ is the snapshot of a
failure, its state before the end: open it with examples/run debug_snapshot. Bold: why a run is no success.</p>
<div class="controls"><input type="search" id="find" placeholder="scenario, behaviour, error ..." aria-label="Find runs">
<select id="set" aria-label="Set"></select><select id="behavior" aria-label="Behaviour"></select>
<select id="outcome" aria-label="Outcome"></select>
<label title="Scenarios in which some behaviours succeed and others do not">
<input type="checkbox" id="split">only where outcomes differ</label>
<span class="soft" id="count" role="status"></span></div>
<div class="scroll"><table id="runs"><thead><tr></tr></thead><tbody></tbody></table></div>
<p><button id="next" hidden>show more</button></p>
<noscript><p>The list needs JavaScript.</p></noscript></section>
)html";

inline constexpr std::string_view report_script = R"js(
const data = JSON.parse(document.getElementById('data').textContent), $ = (id) => document.getElementById(id);
const {groups, columns, outcomes, rows, errors, violations} = data, page = 100;
const head = ['set', 'scenario', 'behaviour', 'outcome', ...columns];
const first = 3;                                   // of the numbers in a row: group, scenario, outcome, ...
const cell = (row, c) => c === 0 ? groups[row[0]].set : c === 1 ? row[1] : c === 2 ? groups[row[0]].label
    : c === 3 ? row[2] : row[c - 4 + first];
rows.forEach((row, i) => { row.index = i; });
const succeeds = new Map();
for (const row of rows) {
  const key = groups[row[0]].hash + ' ' + row[1], seen = succeeds.get(key) || 0;
  succeeds.set(key, seen | (row[2] === 0 ? 1 : 2));
}
const make = (tag, text, name) => {
  const element = document.createElement(tag);
  if (text !== undefined) element.textContent = text;
  if (name) element.className = name;
  return element;
};
const fill = (id, all, names) => {
  $(id).append(new Option(all, ''));
  for (const name of new Set(names)) $(id).append(new Option(name, name));
  $(id).hidden = new Set(names).size < 2;
};
fill('set', 'all sets', groups.map((g) => g.set));
fill('behavior', 'all behaviours', groups.map((g) => g.label));
fill('outcome', 'all outcomes', outcomes.filter((_, o) => rows.some((row) => row[2] === o)));
let sorted = 1, down = false, shown = page, found = rows;
const file = (row, kind) => groups[row[0]].file + '_' + row[1] + kind;
const link = (row, kind) => data.replays.split('/').map(encodeURIComponent).join('/') + '/' + encodeURIComponent(file(row, kind));
const hasReplay = new Set(data.made), hasSnapshot = new Set(data.frozen);
const quoted = (word) => /^[\w:.\/-]+$/.test(word) ? word : "'" + word.replaceAll("'", "'\\''") + "'";
const command = (row) => groups[row[0]].command + (groups[row[0]].source ? ' ' + groups[row[0]].source : '') + ' --only ' + quoted(groups[row[0]].title + ':' + row[1] + ':' +
    groups[row[0]].behavior) + ' --replay ' + quoted(data.folder + '/' + file(row, '.html'));
const violated = (row) => (violations[row.index] || []).map(([frame, text, decides]) => {
  const name = 'violation' + (decides ? ' decisive' : '');
  const item = make(hasReplay.has(row.index) ? 'a' : 'span', text.replaceAll('_', ' '), name);
  if (hasReplay.has(row.index)) item.href = link(row, '.html') + '#frame=' + frame;
  item.onclick = (event) => event.stopPropagation();
  return item;
});
const explain = (line, row) => {
  if (line.nextSibling && line.nextSibling.className === 'more') { line.nextSibling.remove(); return; }
  const more = make('tr', undefined, 'more'), box = make('td');
  box.colSpan = head.length;
  if (errors[row.index]) box.append(make('p', errors[row.index]));
  if (violations[row.index]) box.append(...violated(row));
  box.append(make('p', 'seed ' + data.seeds[row.index] + (data.hits[row.index] ? ', hit agent ' +
      data.hits[row.index] : '') + '. This makes the replay:', 'soft'), make('code', command(row)));
  const copy = make('button', 'copy');
  copy.onclick = () => navigator.clipboard.writeText(command(row)).then(() => { copy.textContent = 'copied'; });
  const then = make('p', 'Then open ', 'soft'), anchor = make('a', 'the replay');
  anchor.href = link(row, '.html');
  then.append(anchor, '. ', copy);
  box.append(then);
  more.append(box);
  line.after(more);
};
const draw = () => {
  const body = $('runs').tBodies[0];
  body.replaceChildren(...found.slice(0, shown).map((row) => {
    const line = make('tr');
    line.tabIndex = 0;
    head.forEach((_, c) => {
      const value = cell(row, c), td = make('td', undefined, c === 2 || c === 3 ? 'left' : '');
      if (c === 3) {
        const mark = make('i');
        mark.style.background = 'var(--o' + value + ')';
        td.append(mark, outcomes[value]);
        if (errors[row.index]) td.title = errors[row.index];
        const items = violated(row), decides = (item) => item.classList.contains('decisive');
        td.append(...items.sort((a, b) => decides(b) - decides(a)).slice(0, 2));
        if (items.length > 2) {
          const rest = make('a', (items.length - 2) + ' more', 'violation');
          rest.href = '#list';
          rest.onclick = (event) => { event.preventDefault(); event.stopPropagation(); explain(line, row); };
          td.append(rest);
        }
      } else if (c === 1 && hasReplay.has(row.index)) {
        const anchor = make('a', '▶ ' + value);
        anchor.href = link(row, '.html');
        td.append(anchor);
        if (hasSnapshot.has(row.index)) {
          const state = make('a', '❄');
          state.href = link(row, '.snapshot');
          state.download = file(row, '.snapshot');
          state.title = 'snapshot before the end, for: examples/run debug_snapshot ' + quoted(data.folder + '/' + file(row, '.snapshot'));
          state.onclick = (event) => event.stopPropagation();
          td.append(' ', state);
        }
      } else {
        td.textContent = value === null ? '–' : value;
      }
      line.append(td);
    });
    const open = () => { if (hasReplay.has(row.index)) location.href = link(row, '.html'); else explain(line, row); };
    line.onclick = open;
    line.onkeydown = (event) => { if (event.key === 'Enter') open(); };
    return line;
  }));
  $('count').textContent = found.length + ' of ' + rows.length + ' runs';
  $('next').hidden = found.length <= shown;
  document.body.dataset.found = found.length;
};
const update = () => {
  const text = $('find').value.toLowerCase().trim(), is = (id, value) => !$(id).value || $(id).value === value;
  found = rows.filter((row) => {
    const group = groups[row[0]];
    return is('set', group.set) && is('behavior', group.label) && is('outcome', outcomes[row[2]]) &&
        (!$('split').checked || succeeds.get(group.hash + ' ' + row[1]) === 3) &&
        (!text || String(row[1]) === text || (group.set + ' ' + group.label + ' ' + outcomes[row[2]] + ' ' +
            (errors[row.index] || '') + ' ' + (violations[row.index] || []).map((item) => item[1]).join(' ').replaceAll('_', ' ')).toLowerCase().includes(text));
  });
  const sign = down ? -1 : 1;
  found.sort((a, b) => {
    const x = cell(a, sorted), y = cell(b, sorted);
    if (x === null || y === null) return (x === null) - (y === null) || a.index - b.index;
    const order = typeof x === 'string' ? (x < y ? -1 : x > y ? 1 : 0) : x - y;
    return sign * order || a.index - b.index;
  });
  shown = page;
  [...$('runs').tHead.rows[0].cells].forEach((th, c) => {
    if (c === sorted) th.setAttribute('aria-sort', down ? 'descending' : 'ascending');
    else th.removeAttribute('aria-sort');
  });
  draw();
};
head.forEach((name, c) => {
  const th = make('th', name, c === 2 || c === 3 ? 'left' : '');
  th.tabIndex = 0;
  th.onclick = () => { down = sorted === c ? !down : false; sorted = c; update(); };
  th.onkeydown = (event) => { if (event.key === 'Enter') th.onclick(); };
  $('runs').tHead.rows[0].append(th);
});
for (const id of ['find', 'set', 'behavior', 'outcome', 'split']) $(id).oninput = update;
$('next').onclick = () => { shown += 5 * page; draw(); };
for (const [key, value] of new URLSearchParams(location.hash.slice(1)))
  if ($(key) && 'value' in $(key)) $(key).value = value;
update();
)js";

}  // namespace cambium::inline v0_1::detail
