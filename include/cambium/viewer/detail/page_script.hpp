#pragma once

#include <string>
#include <string_view>

#include "cambium/core/markup.hpp"

namespace cambium::inline v0_1::detail {

/// What the scripts of both pages begin with: pointers that drag, pinch, turn the wheel and tap, and the scale bar.
inline constexpr std::string_view page_script = R"js(
'use strict';
const element = id => document.getElementById(id);
// Calls pan(dx, dy, fingers), zoom(factor, x, y), tap(x, y) and, with nothing pressed, hover(x, y): pixels of `target`.
function watchPointers(target, {pan, zoom, tap, hover = () => {}}) {
  const pointers = new Map();
  let moved = 0;   // [px] since the first pointer went down
  const place = event => {
    const its = target.getBoundingClientRect();
    return [event.clientX - its.left, event.clientY - its.top];
  };
  // The middle of all pointers, and how far they are apart.
  const grip = () => {
    const all = [...pointers.values()], mean = i => all.reduce((sum, p) => sum + p[i], 0) / all.length;
    const span = all.length < 2 ? 1 : Math.max(1, Math.hypot(all[0][0] - all[1][0], all[0][1] - all[1][1]));
    return {x: mean(0), y: mean(1), span};
  };
  target.addEventListener('pointerdown', event => {
    if (event.button > 0) return;
    target.setPointerCapture(event.pointerId);
    if (!pointers.size) moved = 0;
    pointers.set(event.pointerId, place(event));
  });
  target.addEventListener('pointermove', event => {
    if (!pointers.has(event.pointerId)) return hover(...place(event));
    const last = grip();
    pointers.set(event.pointerId, place(event));
    const now = grip(), dx = now.x - last.x, dy = now.y - last.y;
    moved += Math.hypot(dx, dy) + Math.abs(now.span - last.span);
    if (moved < 4) return;
    target.classList.add('dragging');
    pan(dx, dy, pointers.size);
    if (pointers.size > 1) zoom(now.span / last.span, now.x, now.y);
  });
  for (const end of ['pointerup', 'pointercancel'])
    target.addEventListener(end, event => {
      if (!pointers.delete(event.pointerId) || pointers.size) return;
      target.classList.remove('dragging');
      if (end === 'pointerup' && moved < 4) tap(...place(event));
    });
  target.addEventListener('wheel', event => {
    event.preventDefault();
    zoom(Math.exp(-event.deltaY * (event.ctrlKey ? .01 : event.deltaMode ? .05 : .0015)), ...place(event));
  }, {passive: false});
}
// A bar of a round length, at most `most` pixels at `scale` pixels per metre.
function drawScale(most, scale) {
  const power = 10 ** Math.floor(Math.log10(most / scale));
  const metres = ([5, 2, 1].find(f => f * power * scale <= most) || 1) * power;
  const [text, rule] = element('scale').children;
  text.textContent = metres >= 1000 ? metres / 1000 + ' km' : Number(metres.toPrecision(1)) + ' m';
  rule.style.width = metres * scale + 'px';
}
)js";

/// The beginning of a page, up to its style sheet.
[[nodiscard]] inline std::string page_begin(std::string_view title) {
  return "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<meta name=\"generator\" content=\"cambium\">\n<title>" +
         escape_markup(title) + "</title>\n<style>";
}

}  // namespace cambium::inline v0_1::detail
