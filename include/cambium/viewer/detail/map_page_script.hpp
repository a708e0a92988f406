#pragma once

#include <string_view>

namespace cambium::inline v0_1::detail {

/// The script of a map's page: pan, zoom, search and layers. The picture's view box always has the aspect ratio of the
/// window, so that `view` alone defines what is shown: the point in the middle, in the picture's metres, and the pixels
/// per metre. The address may end in `#at=X,Y,WIDTH` (map coordinates) or `#find=ID`.
inline constexpr std::string_view map_page_script = R"js(
const map = element('map'), box = map.viewBox.baseVal, nav = document.querySelector('nav');
const whole = {x: box.x, y: box.y, width: box.width, height: box.height};
const view = {x: 0, y: 0, scale: 1};
let width = 1, height = 1;
let refit = null;   // finds the view anew when the window changes its size; null once the reader has chosen one
map.removeAttribute('width');
map.removeAttribute('height');
map.setAttribute('tabindex', '0');
map.querySelector('.scale').remove();   // the page's own bar stays in view
element('scale').hidden = false;

function show() {
  box.width = width / view.scale;
  box.height = height / view.scale;
  box.x = view.x - box.width / 2;
  box.y = view.y - box.height / 2;
  drawScale(Math.min(120, width / 3), view.scale);
}
// Shows `part` as large as it fits beside the panel, or below it where the window is narrow.
function fit(part, most) {
  refit = () => fit(part, most);
  const panel = nav.getBoundingClientRect();
  let left = 0, top = 0;
  if (panel.right < width / 2) left = panel.right;
  else if (panel.bottom < height / 2) top = panel.bottom;
  const room = Math.min(40, width / 20);
  view.scale = Math.min(most, Math.max(1, width - left - 2 * room) / Math.max(part.width, 1e-3),
      Math.max(1, height - top - 2 * room) / Math.max(part.height, 1e-3));
  view.x = part.x + part.width / 2 - left / 2 / view.scale;
  view.y = part.y + part.height / 2 - top / 2 / view.scale;
  show();
}
const fitWhole = () => fit(whole, 100);
function pan(dx, dy) {
  const within = (value, low, size, window) => {   // the map is never lost: some of it stays in the window
    const beyond = .4 * window / view.scale;
    return Math.max(low - beyond, Math.min(low + size + beyond, value));
  };
  refit = null;
  view.x = within(view.x - dx / view.scale, whole.x, whole.width, width);
  view.y = within(view.y - dy / view.scale, whole.y, whole.height, height);
  show();
}
// The place under the pixel (x, y) stays there.
function zoom(factor, x = width / 2, y = height / 2) {
  const least = .2 * Math.min(width / whole.width, height / whole.height);
  const scale = Math.max(least, Math.min(500, view.scale * factor));
  view.x += (x - width / 2) * (1 / view.scale - 1 / scale);
  view.y += (y - height / 2) * (1 / view.scale - 1 / scale);
  view.scale = scale;
  pan(0, 0);
}
function resize() {
  const its = map.getBoundingClientRect();
  [width, height] = [Math.max(1, its.width), Math.max(1, its.height)];
  refit ? refit() : show();
}

const lanes = [...map.querySelectorAll('[data-lane]')];
const roadOf = lane => lane.dataset.lane.slice(0, lane.dataset.lane.lastIndexOf(':'));
const kinds = {
  lane: lane => lane.dataset.lane, road: roadOf, junction: lane => lane.dataset.junction,
};
// Neighbours and overlaps lie on a lane of a junction: its mark is a copy above the lanes, and a rim above all layers.
const [marks, rims] = ['marks', 'rims'].map(name => {
  const layer = document.createElementNS(map.namespaceURI, 'g');
  layer.classList.add(name);
  return layer;
});
map.querySelector('.areas').after(marks);
map.append(rims);
function mark(some, text) {
  for (const [layer, name] of [[marks, 'found'], [rims, 'rim']])
    layer.replaceChildren(...some.map(lane => {
      const copy = lane.cloneNode();
      copy.setAttribute('class', name);
      return copy;
    }));
  element('found').textContent = text;
}
// What has no pointer to rest on a lane taps it.
function tap(x, y) {
  const lane = document.elementFromPoint(x, y)?.closest('[data-lane]');
  mark(lane ? [lane] : [], lane ? lane.firstElementChild.textContent : '');
}
// "5:-1", "5", or with its kind where a road and a junction have the same id: "junction 5".
function find(text) {
  const words = text.match(/^(lane|road|junction)\s+(.+)$/i), tries = Object.keys(kinds).map(kind => [kind, text]);
  if (words) tries.push([words[1].toLowerCase(), words[2]]);
  const hits = tries.map(([kind, id]) => [kind, id, lanes.filter(lane => kinds[kind](lane) === id)])
      .filter(([, , some]) => some.length);
  const quoted = words => '\u201c' + words + '\u201d';
  if (!hits.length) return mark([], text && quoted(text) + ' not found: no road, lane or junction here has this id');
  const [[kind, id, some], other] = hits, parts = some.length === 1 ? '' : ': ' + some.length + ' lanes';
  mark(some, kind + ' ' + id + (kind === 'lane' ? '' : parts) +
      (other ? '\nthere is a ' + other[0] + ' ' + id + ', too: look for ' + quoted(other[0] + ' ' + id) : ''));
  const boxes = some.map(lane => lane.getBBox());
  const low = side => Math.min(...boxes.map(b => b[side]));
  const high = (side, size) => Math.max(...boxes.map(b => b[side] + b[size]));
  fit({x: low('x'), y: low('y'), width: high('x', 'width') - low('x'), height: high('y', 'height') - low('y')}, 30);
}
document.querySelector('form').addEventListener('submit', event => {
  event.preventDefault();
  find(element('find').value.trim());
});

element('whole').addEventListener('click', fitWhole);
for (const input of document.querySelectorAll('nav input[type=checkbox]'))
  input.addEventListener('change', () => {
    for (const layer of map.getElementsByClassName(input.name)) layer.style.display = input.checked ? '' : 'none';
  });
const keys = {
  ArrowLeft: () => pan(width / 8, 0), ArrowRight: () => pan(-width / 8, 0),
  ArrowUp: () => pan(0, height / 8), ArrowDown: () => pan(0, -height / 8),
  '+': () => zoom(1.25), '=': () => zoom(1.25), '-': () => zoom(.8), '0': fitWhole,
  '/': () => { element('find').focus(); element('find').select(); },
  Escape: () => mark([], ''),
};
document.addEventListener('keydown', event => {
  if (event.ctrlKey || event.metaKey || event.altKey || !keys[event.key]) return;
  if (event.target.type === 'search') {
    if (event.key !== 'Escape') return;
    map.focus();
  }
  event.preventDefault();
  keys[event.key]();
});

function obeyAddress() {
  const wish = location.hash.match(/^#(at|find)=(.*)$/);
  if (!wish) return;
  let text = wish[2];
  try { text = decodeURIComponent(text); } catch {}
  if (wish[1] === 'find') return find(element('find').value = text.trim());
  const [x, y, across] = text.split(',').map(Number);
  if (!(across > 0 && Number.isFinite(x + y + across))) return;
  refit = null;
  Object.assign(view, {x: x - map.dataset.west, y: map.dataset.north - y, scale: width / across});
  show();
}
if (innerWidth < 700 && element('legend')) element('legend').open = false;
watchPointers(map, {pan, zoom, tap});
refit = fitWhole;
resize();
addEventListener('resize', resize);
addEventListener('hashchange', obeyAddress);
obeyAddress();
)js";

}  // namespace cambium::inline v0_1::detail
