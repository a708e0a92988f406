#pragma once

#include <string_view>

namespace cambium::inline v0_1::detail {

/// Second half of the replay page's script: the displays around the map, the controls, and `window.replay` for tests.
/// The address may end in `#frame=12`, `#play`, `#select=id`, `#follow=0`, `#fit`, `#probe=x,y;x,y` (map coordinates),
/// or several of them joined by `&`.
inline constexpr std::string_view replay_controls_script = R"js(
const number = (value, digits) => value.toFixed(digits).replace('-', '\u2212');
function drawTip() {
  const tip = element('tip'), i = state.hovered >= 0 ? state.hovered : state.selected;
  const pose = i >= 0 ? poseOf(i, state.at) : null;
  tip.hidden = !pose && !state.lane;
  if (tip.hidden) return;
  if (!pose) {
    tip.replaceChildren('lane ' + state.lane.label);
    return putTip(tip, ...state.pointer);
  }
  const agent = agents[i], title = document.createElement('b');
  title.textContent = (agent.label ? agent.label + ' \u00b7 ' : '') + 'id ' + agent.id;
  const speed = number(pose.speed, 1) + ' m/s (' + number(pose.speed * 3.6, 0) + ' km/h)';
  tip.replaceChildren(title, speed + ', ' + number(pose.acceleration, 2) + ' m/s\u00b2');
  putTip(tip, ...toScreen(...middleOf(agent, pose)));
}
function putTip(tip, x, y) {
  tip.style.left = Math.max(4, Math.min(x + 16, width - tip.offsetWidth - 4)) + 'px';
  tip.style.top = Math.max(4, Math.min(y - tip.offsetHeight - 16, height - tip.offsetHeight - 4)) + 'px';
}
function drawClock() {
  const k = Math.min(Math.floor(state.at), count - 1);
  const strong = document.createElement('b'), where = document.createElement('span');
  where.textContent = ' \u00b7 frame ' + Math.max(k, 0);
  strong.textContent = count ? timeAt(state.at).toFixed(1) : '0.0';
  element('clock').replaceChildren(strong, ' / ' + (count ? data.times[count - 1] : 0).toFixed(1) + ' s', where);
  element('slider').value = state.at;
  document.body.dataset.frame = Math.max(k, 0);
}
function draw() {
  const target = state.follow && count ? followed() : -1, pose = target >= 0 && poseOf(target, state.at);
  if (pose) [camera.x, camera.y] = middleOf(agents[target], pose);
  drawMap();
  if (count) {
    for (const i of new Set([ego, state.selected])) drawTrail(i);
    for (const i of [...agents.keys()].sort((a, b) => (a === ego) - (b === ego))) drawAgent(i);
  }
  drawTip();
  drawScale(130, camera.scale);
  drawClock();
  element('follow').checked = state.follow;
}
// At the next painted frame, or soon after it should have come: a browser without a screen paints none.
function soon(action) {
  let done = false;
  const once = () => {
    if (done) return;
    done = true;
    action(performance.now());
  };
  requestAnimationFrame(once);
  setTimeout(once, 100);
}
let waiting = false;
function redraw() {
  if (waiting) return;
  waiting = true;
  soon(() => { waiting = false; draw(); });
}

const icons = {play: 'M3 1.5v13L14 8z', pause: 'M3 2h3.6v12H3zM9.4 2H13v12H9.4z'};
let before = null, run = 0;   // time of the last tick [ms], number of the current run
function tick(now, its) {
  if (!state.playing || its !== run) return;
  const step = before === null ? 0 : Math.min(.25, (now - before) / 1000) * Number(element('speed').value);
  before = now;
  const time = timeAt(state.at) + step;
  let k = Math.floor(state.at);
  while (k + 1 < count && data.times[k + 1] <= time) ++k;
  state.at = k + 1 < count ? k + (time - data.times[k]) / (data.times[k + 1] - data.times[k]) : count - 1;
  if (state.at >= count - 1) pause(); else soon(later => tick(later, its));
  draw();
}
function setPlaying(on) {
  state.playing = on;
  before = null;
  element('play').setAttribute('aria-label', on ? 'Pause' : 'Play');
  element('play').querySelector('path').setAttribute('d', on ? icons.pause : icons.play);
}
function play() {
  if (count < 2 || state.playing) return;
  if (state.at >= count - 1) state.at = 0;
  setPlaying(true);
  const its = ++run;
  soon(now => tick(now, its));
}
function pause() { setPlaying(false); }
function seek(at) {
  state.at = Math.max(0, Math.min(Number(at) || 0, count - 1));
  draw();
}
function stepBy(frames) { pause(); seek(frames < 0 ? Math.ceil(state.at) + frames : Math.floor(state.at) + frames); }
function zoom(factor, x, y) {
  const [mx, my] = toMap(x, y);
  refit = null;
  camera.scale = Math.max(.02, Math.min(200, camera.scale * factor));
  if (!state.follow) {
    camera.x = mx - (x - width / 2) / camera.scale;
    camera.y = my + (y - height / 2) / camera.scale;
  }
  redraw();
}
function agentAt(x, y) {
  const [mx, my] = toMap(x, y), room = 5 / camera.scale;
  for (let i = agents.length - 1; i >= 0; --i) {
    const pose = poseOf(i, state.at), agent = agents[i];
    if (!pose) continue;
    const c = Math.cos(pose.heading), s = Math.sin(pose.heading), dx = mx - pose.x, dy = my - pose.y;
    const u = c * dx + s * dy, v = c * dy - s * dx;
    const inside = (value, low, high) => value > -low - room && value < high + room;
    if (inside(u, agent.rear, agent.front) && inside(v, agent.right, agent.left)) return i;
  }
  return -1;
}

function pan(dx, dy, fingers) {
  if (fingers < 2) state.follow = false;
  refit = null;
  if (!state.follow) {
    camera.x -= dx / camera.scale;
    camera.y += dy / camera.scale;
  }
  redraw();
}
function hover(x, y) {
  state.hovered = count ? agentAt(x, y) : -1;
  state.lane = state.hovered < 0 && state.selected < 0 ? laneAt(x, y) : null;
  state.pointer = [x, y];
  canvas.classList.toggle('over', state.hovered >= 0);
  redraw();
}
function tap(x, y) {
  if (count) state.selected = agentAt(x, y);
  redraw();
}
watchPointers(canvas, {pan, zoom, tap, hover});
canvas.addEventListener('pointerleave', () => { state.hovered = -1; state.lane = null; redraw(); });

const showAll = () => { state.follow = false; fit(); redraw(); };
element('play').addEventListener('click', () => { state.playing ? pause() : play(); });
element('back').addEventListener('click', () => stepBy(-1));
element('next').addEventListener('click', () => stepBy(1));
element('fit').addEventListener('click', showAll);
element('slider').addEventListener('input', event => { pause(); seek(event.target.value); });
element('follow').addEventListener('change', event => {
  state.follow = event.target.checked;
  refit = null;
  if (state.follow && camera.scale < 2) camera.scale = width / 150;
  redraw();
});
element('ids').addEventListener('change', event => { state.ids = event.target.checked; redraw(); });
const keys = {
  ' ': () => state.playing ? pause() : play(), ArrowLeft: () => stepBy(-1), ArrowRight: () => stepBy(1),
  Home: () => seek(0), End: () => seek(count - 1),
  '+': () => zoom(1.25, width / 2, height / 2), '-': () => zoom(.8, width / 2, height / 2), f: showAll,
};
document.addEventListener('keydown', event => {
  const control = event.target.matches('select, input[type=checkbox], button:not(#play)');
  const own = control && [' ', 'ArrowLeft', 'ArrowRight'].includes(event.key);
  if (!keys[event.key] || own || event.ctrlKey || event.metaKey || event.altKey || !count) return;
  event.preventDefault();
  keys[event.key]();
});
element('play').addEventListener('keyup', event => { if (event.key === ' ') event.preventDefault(); });

// Colour on the canvas at a place of the map, as "r,g,b"; the view moves there first when it does not show the place.
function pixel(x, y) {
  const kept = {...camera}, follow = state.follow, at = [x - data.origin[0], y - data.origin[1]];
  let [sx, sy] = toScreen(...at);
  if (sx < 0 || sy < 0 || sx >= width || sy >= height) {
    [camera.x, camera.y] = at;
    state.follow = false;
  }
  draw();
  [sx, sy] = toScreen(...at);
  const rgb = context.getImageData(Math.floor(sx * ratio), Math.floor(sy * ratio), 1, 1).data.slice(0, 3).join(',');
  Object.assign(camera, kept);
  state.follow = follow;
  draw();
  return rgb;
}
function obeyAddress() {
  const wish = new URLSearchParams(location.hash.slice(1));
  if (wish.has('fit')) showAll();
  if (wish.has('follow')) [state.follow, refit] = [wish.get('follow') !== '0', null];
  if (wish.has('select')) {
    state.selected = agents.findIndex(agent => agent.id === wish.get('select'));
  }
  if (wish.has('frame')) seek(wish.get('frame'));
  if (wish.has('play')) play();
  const places = (wish.get('probe') || '').split(';').filter(Boolean);
  const colours = places.map(place => pixel(...place.split(',').map(Number)));
  if (colours.length) document.body.dataset.pixel = colours.join(';');
}
function start() {
  element('slider').max = Math.max(count - 1, 0);
  for (const id of ['play', 'back', 'next', 'slider', 'speed']) element(id).disabled = count < 2;
  if (!count || !agents.length) {
    element('nothing').textContent = count ? 'This recording has no vehicles.' : 'This recording has no frames.';
    element('nothing').hidden = false;
  }
  const names = {other: 'Traffic', ego: 'Ego', merging: 'Joining or leaving', static: 'Obstacle', collided: 'Collided', brake: 'Braking'};
  const shown = kinds.filter((_, k) => agents.some(agent => agent.kind === k));
  if (data.frames.some(poses => poses.some(pose => pose && pose[4] < -2))) shown.push('brake');
  element('legend').replaceChildren(...(count ? shown : []).map(kind => {
    const entry = document.createElement('span');
    entry.style.setProperty('--swatch', 'var(--' + kind + ')');
    entry.textContent = names[kind];
    return entry;
  }));
  readColours();
  resize();
  firstView();
  draw();
  window.replay = {frame: () => Number(document.body.dataset.frame), seek, play, pause, pixel};
  new ResizeObserver(() => { resize(); if (refit) refit(); draw(); }).observe(canvas);
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => { readColours(); draw(); });
  window.addEventListener('hashchange', obeyAddress);
  obeyAddress();
  document.body.dataset.ready = count;
}
start();
)js";

}  // namespace cambium::inline v0_1::detail
