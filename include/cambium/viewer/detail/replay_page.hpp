#pragma once

#include <string_view>

namespace cambium::inline v0_1::detail {

/// Style sheet of the replay page. The canvas reads its colours from these variables, so that light and dark mode are
/// defined in one place.
inline constexpr std::string_view replay_style = R"css(
:root {
  color-scheme: light dark;
  --page: #f4f6f8; --panel: #ffffff; --line: #d9dfe5; --text: #16202b; --soft: #5b6a79; --accent: #1273eb;
  --ground: #e6ebe4; --asphalt: #6d747d; --verge: #8d949c; --crossing: #676e77; --paint: #ffffff; --centre: #ffd54a;
  --other: #eef1f4; --ego: #1e90ff; --merging: #ffab1f; --static: #b79bff; --collided: #e0218a; --outline: #1b2430; --glass: #33404e;
  --brake: #ff2222; --ring: #ffffff; --go: #2fd05f; --caution: #ffd21f; --halt: #ff3b30;
}
@media (prefers-color-scheme: dark) {
  :root {
    --page: #0f141a; --panel: #182029; --line: #2a3541; --text: #e8eef5; --soft: #93a3b3; --accent: #4da3ff;
    --ground: #141b20; --asphalt: #3a434d; --verge: #2b333b; --crossing: #3e4852; --paint: #c9d3dd; --centre: #d8b545;
    --other: #c4ced8; --ego: #2f9bff; --outline: #0a0e13; --glass: #1c2630;
  }
}
* { box-sizing: border-box; }
html, body { height: 100%; margin: 0; }
body {
  display: flex; flex-direction: column; height: 100dvh; background: var(--page); color: var(--text);
  font: 14px/1.4 system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", sans-serif;
}
header { padding: 10px 16px 8px; background: var(--panel); border-bottom: 1px solid var(--line); }
.head { display: flex; flex-wrap: wrap; align-items: baseline; gap: 2px 14px; }
h1 { margin: 0; font-size: 17px; font-weight: 650; overflow-wrap: anywhere; }
.meta { color: var(--soft); font-size: 13px; }
.notes {
  display: flex; flex-wrap: wrap; gap: 6px; margin: 6px 0 0; padding: 0; list-style: none; max-height: 22vh;
  overflow: auto;
}
.notes li {
  padding: 1px 9px; border: 1px solid var(--line); border-radius: 99px; font-size: 12.5px;
  background: var(--page); overflow-wrap: anywhere;
}
.notes:empty { display: none; }
main { position: relative; flex: 1; min-height: 120px; overflow: hidden; background: var(--ground); }
canvas {
  position: absolute; inset: 0; width: 100%; height: 100%; display: block; touch-action: none; cursor: grab;
  outline: none;
}
canvas.dragging { cursor: grabbing; }
canvas.over { cursor: pointer; }
#legend, #scale, #tip, #nothing {
  position: absolute; background: color-mix(in srgb, var(--panel) 88%, transparent);
  border: 1px solid var(--line); border-radius: 8px; font-size: 12px;
}
#legend {
  left: 12px; bottom: 12px; padding: 5px 10px; display: flex; flex-wrap: wrap; gap: 2px 12px;
  pointer-events: none; max-width: calc(100% - 180px);
}
#legend span::before {
  content: ""; display: inline-block; width: 14px; height: 8px; margin-right: 6px; border-radius: 2px;
  background: var(--swatch); box-shadow: 0 0 0 1px var(--outline);
}
#legend:empty { display: none; }
#scale { right: 12px; bottom: 12px; padding: 3px 10px 7px; text-align: center; pointer-events: none; }
#scale i { display: block; height: 5px; border: 1.5px solid var(--text); border-top: 0; }
#tip {
  padding: 6px 10px; pointer-events: none; white-space: nowrap; font-variant-numeric: tabular-nums;
  box-shadow: 0 4px 14px #0003;
}
#tip b { display: block; }
#nothing {
  inset: auto 0 14px; margin: 0 auto; width: max-content; max-width: 90%; height: max-content; padding: 14px 20px;
  font-size: 15px;
}
[hidden] { display: none !important; }
footer {
  display: flex; flex-wrap: wrap; align-items: center; gap: 8px 12px;
  padding: 9px 16px max(9px, env(safe-area-inset-bottom)); background: var(--panel);
  border-top: 1px solid var(--line);
}
.group { display: flex; align-items: center; gap: 6px; }
button, select {
  height: 34px; min-width: 34px; padding: 0 9px; border: 1px solid var(--line); border-radius: 8px;
  background: var(--page); color: inherit; font: inherit; cursor: pointer;
}
button:hover, select:hover { border-color: var(--accent); }
button:disabled, select:disabled { opacity: .45; cursor: default; }
button svg { display: block; width: 16px; height: 16px; fill: currentColor; margin: auto; }
#play { width: 46px; background: var(--accent); border-color: var(--accent); color: #fff; }
:focus-visible { outline: 2px solid var(--accent); outline-offset: 2px; }
#slider { flex: 1 1 220px; min-width: 120px; height: 34px; margin: 0; accent-color: var(--accent); cursor: pointer; }
#clock {
  min-width: 148px; text-align: right; color: var(--soft); font-variant-numeric: tabular-nums;
  white-space: nowrap;
}
#clock b { color: var(--text); font-weight: 600; }
label { display: inline-flex; align-items: center; gap: 5px; cursor: pointer; white-space: nowrap; }
input[type=checkbox] { width: 16px; height: 16px; margin: 0; accent-color: var(--accent); }
@media (max-width: 640px) {
  header { padding: 8px 12px 6px; }
  h1 { font-size: 15px; }
  .notes { flex-wrap: nowrap; overflow-x: auto; scrollbar-width: none; }
  .notes li { white-space: nowrap; flex: none; }
  footer { padding: 8px 12px; gap: 6px 10px; }
  footer select, footer #fit { padding: 0 6px; }
  #slider { order: -2; flex: 1 1 0; }
  #clock { order: -2; min-width: 0; }
  #clock span { display: none; }
  footer::before { content: ""; order: -1; flex-basis: 100%; }
  #legend { left: 8px; bottom: 8px; max-width: calc(100% - 16px); }
  #scale { right: 8px; top: 8px; bottom: auto; }
}
)css";

/// Body of the replay page between its header and its data: the canvas and the controls.
inline constexpr std::string_view replay_body = R"html(<main>
<canvas id="view" tabindex="0"
  aria-label="Map with vehicles. Drag to move, wheel or pinch to zoom, click a vehicle for its values."></canvas>
<div id="legend"></div>
<div id="scale" aria-hidden="true"><span></span><i></i></div>
<div id="tip" role="status" hidden></div>
<p id="nothing" hidden></p>
<noscript><p id="nothing">This page needs JavaScript to play the recording.</p></noscript>
</main>
<footer>
<div class="group">
<button id="back" title="One frame back (left arrow)" aria-label="One frame back">
  <svg viewBox="0 0 16 16"><path d="M2 2h2.5v12H2zM14 2v12L6 8z"/></svg></button>
<button id="play" title="Play or pause (space)" aria-label="Play">
  <svg viewBox="0 0 16 16"><path d="M3 1.5v13L14 8z"/></svg></button>
<button id="next" title="One frame on (right arrow)" aria-label="One frame on">
  <svg viewBox="0 0 16 16"><path d="M11.5 2H14v12h-2.5zM2 2l8 6-8 6z"/></svg></button>
</div>
<input id="slider" type="range" min="0" max="0" step="any" value="0" aria-label="Time">
<div id="clock"></div>
<div class="group">
<select id="speed" title="Speed of the replay" aria-label="Speed of the replay">
  <option value="0.5">0.5×</option><option value="1" selected>1×</option>
  <option value="2">2×</option><option value="4">4×</option>
</select>
<label title="Keep the chosen vehicle, or else the ego, in the middle"><input id="follow" type="checkbox">Follow</label>
<label title="Write the number of each vehicle beside it"><input id="ids" type="checkbox">Ids</label>
<button id="fit" title="Show the whole map (F)">Fit</button>
</div>
</footer>
)html";

}  // namespace cambium::inline v0_1::detail
