#pragma once

#include <string_view>

namespace cambium::inline v0_1::detail {

/// First half of the replay page's script: the data, the pose of an agent at any time, the camera and the drawing.
/// Coordinates are metres relative to the recording's origin. `at` is a frame number, fractional between two frames.
inline constexpr std::string_view replay_scene_script = R"js(
const data = JSON.parse(document.getElementById('recording').textContent);
const canvas = element('view'), context = canvas.getContext('2d');
const count = data.times.length, agents = data.agents.map(([id, kind, label, front, rear, left, right]) =>
  ({id, kind, label, front, rear, left, right, length: front + rear, width: left + right}));
const ego = [4, 1].map(kind => agents.findIndex(agent => agent.kind === kind)).find(i => i >= 0) ?? -1;
const kinds = ['other', 'ego', 'merging', 'static', 'collided'], surfaces = ['asphalt', 'verge', 'crossing', 'verge'];
const lamps = ['', 'go', 'caution', 'halt'];   // a light's colours: off, green, yellow, red
const state = {at: 0, playing: false, follow: false, selected: -1, hovered: -1, lane: null, ids: false};
const camera = {x: 0, y: 0, scale: 1};   // middle of the view [m], pixels per metre
let width = 1, height = 1, ratio = 1, colour = {};
let refit = null;   // finds the view anew when the page changes its size; null once the user has chosen one

const trace = (path, points) => {
  path.moveTo(points[0], points[1]);
  for (let i = 2; i < points.length; i += 2) path.lineTo(points[i], points[i + 1]);
};
const lanes = data.lanes.map(([kind, label, points]) => {
  const path = new Path2D();
  trace(path, points);
  path.closePath();
  return {kind, label, path};
});
const surfacePaths = [3, 1, 0, 2].map(kind => {
  const path = new Path2D();
  for (const lane of lanes) if (lane.kind === kind) path.addPath(lane.path);
  return [surfaces[kind], path];
});
const markPaths = [0, 1, 2].map(style => {
  const path = new Path2D();
  for (const [its, points] of data.marks) if (its === style) trace(path, points);
  return path;
});
const arrowPath = new Path2D();
for (const [x, y, heading] of data.arrows) {
  const c = Math.cos(heading), s = Math.sin(heading);
  const shape = [[-2, .1], [.6, .1], [.6, .45], [2, 0], [.6, -.45], [.6, -.1], [-2, -.1]];
  trace(arrowPath, shape.flatMap(([u, v]) => [x + c * u - s * v, y + s * u + c * v]));
  arrowPath.closePath();
}

function poseOf(agent, at) {
  const k = Math.min(Math.floor(at), count - 1), u = at - k, a = count ? data.frames[k][agent] : 0;
  if (!a) return null;
  const b = u > 0 && k + 1 < count && data.frames[k + 1][agent];
  if (!b) return {x: a[0], y: a[1], heading: a[2], speed: a[3], acceleration: a[4]};
  const turn = Math.atan2(Math.sin(b[2] - a[2]), Math.cos(b[2] - a[2])), mix = i => a[i] + (b[i] - a[i]) * u;
  return {x: mix(0), y: mix(1), heading: a[2] + turn * u, speed: mix(3), acceleration: u < .5 ? a[4] : b[4]};
}
const timeAt = at => {
  const k = Math.min(Math.floor(at), count - 1), u = at - k;
  return k + 1 < count ? data.times[k] + (data.times[k + 1] - data.times[k]) * u : data.times[k];
};
// What the traffic lights show, a digit each.
const lightsAt = at => (data.lights.findLast(([first]) => first <= at) || [0, ''])[1];
const toScreen = (x, y) => [(x - camera.x) * camera.scale + width / 2, (camera.y - y) * camera.scale + height / 2];
const toMap = (x, y) => [(x - width / 2) / camera.scale + camera.x, camera.y - (y - height / 2) / camera.scale];
const middleOf = (agent, pose) => {
  const u = (agent.front - agent.rear) / 2, v = (agent.left - agent.right) / 2;
  const c = Math.cos(pose.heading), s = Math.sin(pose.heading);
  return [pose.x + c * u - s * v, pose.y + s * u + c * v];
};
const followed = () => state.selected >= 0 ? state.selected : ego >= 0 ? ego : agents.findIndex((_, i) => poseOf(i, 0));

function laneAt(x, y) {
  context.setTransform(1, 0, 0, 1, 0, 0);
  return lanes.findLast(lane => lane.label && context.isPointInPath(lane.path, ...toMap(x, y))) || null;
}

function extent() {
  let box = [Infinity, Infinity, -Infinity, -Infinity];
  const add = (x, y) => { box = [Math.min(box[0], x), Math.min(box[1], y), Math.max(box[2], x), Math.max(box[3], y)]; };
  for (const [, , points] of data.lanes) for (let i = 0; i < points.length; i += 2) add(points[i], points[i + 1]);
  if (!data.lanes.length) for (const poses of data.frames) for (const p of poses) if (p) add(p[0], p[1]);
  return box[0] <= box[2] ? box : [-50, -50, 50, 50];
}
function fit() {
  refit = fit;
  const [x0, y0, x1, y1] = extent(), room = Math.min(60, width * .06);
  camera.x = (x0 + x1) / 2;
  camera.y = (y0 + y1) / 2;
  camera.scale = Math.min((width - 2 * room) / Math.max(x1 - x0, 10), (height - 2 * room) / Math.max(y1 - y0, 10), 40);
}
// The whole map where it is small; else a window of 150 m (80 m on a phone) around the followed vehicle.
function firstView() {
  const [x0, y0, x1, y1] = extent(), span = width < 700 ? 80 : 150;
  fit();
  refit = firstView;
  if (Math.max(x1 - x0, y1 - y0) <= span || followed() < 0) return;
  camera.scale = width / span;
  state.follow = true;
}
function resize() {
  ratio = Math.max(1, window.devicePixelRatio || 1);
  [width, height] = [Math.max(1, canvas.clientWidth), Math.max(1, canvas.clientHeight)];
  [canvas.width, canvas.height] = [Math.round(width * ratio), Math.round(height * ratio)];
}
function readColours() {
  const style = getComputedStyle(document.documentElement);
  const names = ['ground', ...surfaces, 'paint', 'centre', ...kinds, 'outline', 'glass', 'brake', 'ring', 'text',
    'panel', ...lamps.slice(1)];
  for (const name of names) colour[name] = style.getPropertyValue('--' + name).trim();
}

function drawMap() {
  const s = camera.scale * ratio, px = 1 / camera.scale;
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.fillStyle = colour.ground;
  context.fillRect(0, 0, width, height);
  context.setTransform(s, 0, 0, -s, ratio * width / 2 - camera.x * s, ratio * height / 2 + camera.y * s);
  context.lineJoin = 'round';
  for (const [name, path] of surfacePaths) {
    context.fillStyle = context.strokeStyle = colour[name];
    context.lineWidth = Math.max(.06, px);   // covers the hair lines between neighbours
    context.fill(path);
    context.stroke(path);
  }
  context.strokeStyle = context.fillStyle = colour.paint;
  context.globalAlpha = .55;
  if (camera.scale > 2) context.fill(arrowPath);
  context.globalAlpha = camera.scale > 1.2 ? .95 : .6;
  context.lineWidth = Math.max(.16, 1.1 * px);
  context.stroke(markPaths[0]);
  context.setLineDash([3, 6]);
  context.lineWidth = Math.max(.14, px);
  if (camera.scale > 1.2) context.stroke(markPaths[1]);
  context.setLineDash([]);
  context.strokeStyle = colour.centre;
  context.stroke(markPaths[2]);
  context.globalAlpha = 1;
  drawStops();
}
// Stop lines, and behind each the lamp of its light where that is on.
function drawStops() {
  const shown = lightsAt(state.at), px = 1 / camera.scale, radius = Math.max(.6, 4 * px);
  const disc = (x, y, r, name) => {
    context.fillStyle = colour[name];
    context.beginPath();
    context.arc(x, y, r, 0, 7);
    context.fill();
  };
  context.strokeStyle = colour.paint;
  context.lineWidth = Math.max(.4, 1.5 * px);
  for (const [[x0, y0, x1, y1], light] of data.stops) {
    context.beginPath();
    trace(context, [x0, y0, x1, y1]);
    context.stroke();
    const lamp = lamps[shown[light]], away = (.4 + 1.3 * radius) / (Math.hypot(x1 - x0, y1 - y0) || 1);
    const x = (x0 + x1) / 2 + (y0 - y1) * away, y = (y0 + y1) / 2 + (x1 - x0) * away;
    if (lamp) disc(x, y, 1.3 * radius, 'outline'), disc(x, y, radius, lamp);
  }
}
function drawTrail(i) {
  if (i < 0) return;
  const end = timeAt(state.at);
  const now = poseOf(i, state.at);
  if (!now) return;
  context.beginPath();
  context.moveTo(...middleOf(agents[i], now));
  for (let k = Math.floor(state.at); k >= 0 && data.times[k] > end - 4; --k) {
    const pose = poseOf(i, k);
    if (!pose) break;
    context.lineTo(...middleOf(agents[i], pose));
  }
  context.globalAlpha = .45;
  context.strokeStyle = colour[kinds[agents[i].kind]];
  context.lineWidth = Math.max(.35, 2 / camera.scale);
  context.lineCap = 'round';
  context.stroke();
  context.lineCap = 'butt';
  context.globalAlpha = 1;
}
function drawAgent(i) {
  const pose = poseOf(i, state.at), agent = agents[i];
  if (!pose) return;
  const {length, width: breadth, front, rear, right} = agent, px = 1 / camera.scale;
  const fixed = agent.kind === 3, walks = !fixed && Math.max(length, breadth) < 1.2;
  const rides = !fixed && !walks && breadth < 1 && length < 3;
  // Vehicles are to scale, but no smaller than can be seen from afar.
  const along = walks ? Math.max(1, 7 * px / Math.max(length, breadth)) : Math.max(1, 10 * px / Math.max(length, .5));
  const across = walks || rides ? along : Math.max(1, 5 * px / Math.max(breadth, .5));
  context.save();
  context.translate(pose.x, pose.y);
  context.rotate(pose.heading);
  context.scale(along, across);
  const body = new Path2D(), x = (front - rear) / 2, y = (agent.left - right) / 2;
  if (rides) drawWheels(agent, px / across);
  if (walks || rides) body.ellipse(x, y, walks ? .33 * length : .16 * length, .5 * breadth, 0, 0, 7);   // shoulders
  else body.roundRect(-rear, -right, length, breadth, fixed ? .05 : Math.min(.28 * breadth, .12 * length));
  if (i === state.selected || i === state.hovered || [1, 4].includes(agent.kind)) {
    context.strokeStyle = colour.ring;
    context.lineWidth = (i === state.selected ? 6 : 4) * px / across;
    context.stroke(body);
  }
  context.fillStyle = colour[kinds[agent.kind]];
  context.fill(body);
  context.strokeStyle = colour.outline;
  context.lineWidth = (along > 1 ? .6 : 1.1) * px / across;
  context.stroke(body);
  if (walks || rides) {   // the head, a little ahead of the shoulders
    context.beginPath();
    context.arc(x + .08 * length, y, .24 * breadth, 0, 7);
    context.fillStyle = colour.glass;
    context.fill();
  } else if (!fixed && along === 1) drawFace(agent, pose);
  else if (!fixed && pose.acceleration < -2) {
    context.fillStyle = colour.brake;
    context.fillRect(-rear, -right, .3 * length, breadth);
  }
  context.restore();
  if (state.ids && camera.scale > 1.5) drawNumber(agent, pose);
}
// Two wheels, the frame between them, and a handlebar.
function drawWheels({length, width: breadth, front, rear, left, right}, px) {
  const y = (left - right) / 2, bar = front - .3 * length, wheel = .36 * length;
  const line = (x0, y0, x1, y1, thick) => {
    context.lineWidth = Math.max(thick, px);
    context.beginPath();
    context.moveTo(x0, y0);
    context.lineTo(x1, y1);
    context.stroke();
  };
  context.strokeStyle = colour.outline;
  context.lineCap = 'round';
  line(-rear, y, front, y, .05);
  line(-rear + .05, y, -rear + wheel, y, .11);
  line(front - wheel, y, front - .05, y, .11);
  line(bar, y - .5 * breadth, bar, y + .5 * breadth, .07);
  context.lineCap = 'butt';
}
// Windscreen and rear window say where the front is; the tail lights up when the vehicle brakes.
function drawFace({length, width: breadth, front, rear, left, right}, pose) {
  const long = length > 7, screen = front - (long ? .5 : .24 * length), depth = long ? .7 : .15 * length;
  const y = (left - right) / 2;
  const pane = (x0, x1, narrow0, narrow1) => {
    context.beginPath();
    const v0 = narrow0 * breadth, v1 = narrow1 * breadth;
    trace(context, [x0, y + v0, x1, y + v1, x1, y - v1, x0, y - v0]);
    context.fill();
  };
  context.fillStyle = colour.glass;
  pane(screen, screen - depth, .43, .35);
  if (!long && length * camera.scale > 22) pane(-rear + .09 * length, -rear + .17 * length, .36, .31);
  if (pose.acceleration < -2) {
    const thick = Math.max(.07 * Math.min(length, 5), 2 / camera.scale);
    context.fillStyle = colour.brake;
    context.fillRect(-rear - thick * .6, -right + .04 * breadth, thick, breadth * .92);
    context.globalAlpha = .3;
    context.fillRect(-rear - thick * 2.2, -right - .06 * breadth, thick * 1.8, breadth * 1.12);
    context.globalAlpha = 1;
  }
}
function drawNumber(agent, pose) {
  const [x, y] = toScreen(...middleOf(agent, pose));
  context.save();
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.font = '600 11px system-ui, sans-serif';
  context.textAlign = 'center';
  context.lineWidth = 3;
  context.strokeStyle = colour.panel;
  context.fillStyle = colour.text;
  const up = y - Math.max(.75 * agent.width * camera.scale, 9) - 3;
  context.strokeText(agent.id, x, up);
  context.fillText(agent.id, x, up);
  context.restore();
}
)js";

}  // namespace cambium::inline v0_1::detail
