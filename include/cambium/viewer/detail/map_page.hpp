#pragma once

#include <string>
#include <string_view>

#include "cambium/viewer/detail/map_legend.hpp"
#include "cambium/viewer/detail/svg_panel.hpp"
#include "cambium/viewer/detail/text.hpp"

namespace cambium::detail {

/// The look of a map's picture; the classes of areas are OpenDRIVE's words for lane types.
inline constexpr std::string_view map_picture_style =
    ".ground{fill:#eef1ec}"
    ".areas path{fill:#cdd6c6;stroke:#fff;stroke-width:.12}"
    ".areas .driving{fill:#8b939c}.areas .junction{fill:#a2a9b1;stroke:#c7ccd1}"
    ".areas .shoulder,.areas .border,.areas .stop,.areas .curb{fill:#bcc3c9}"
    ".areas .sidewalk,.areas .walking{fill:#dccfb8}.areas .biking{fill:#c99a8b}"
    ".areas .parking{fill:#a9b9d6}.areas .bus,.areas .taxi,.areas .HOV{fill:#a68f74}"
    ".areas .restricted,.areas .roadWorks{fill:#d5b3b3}.areas .tram,.areas .rail{fill:#a3a37f}"
    ".areas path:hover{fill:#5b9bd5}"
    ".conflicts{opacity:.28}.conflicts path{fill:#d4456b;stroke:#700622;stroke-width:.06}"
    ".overlaps path{fill:none;stroke-width:.9;opacity:.4}"
    ".crossing{stroke:#e02b2b}.merge{stroke:#ff8c1a}.split{stroke:#8e44ec}"
    ".arrows path{fill:#fff;opacity:.85}"
    ".links path{fill:none;stroke:#0a8f4b;stroke-width:.18;opacity:.8}.links .tip{fill:#0a8f4b;stroke:none}"
    ".links .end circle{fill:#d61f1f}.links .begin circle{fill:#1f6fd6}"
    ".labels text{fill:#101820;text-anchor:middle;pointer-events:none}"
    ".legend text{fill:#101820}.scale{fill:#101820}";

/// What makes the picture's view box follow the mouse wheel and the pointer, and the boxes switch layers.
inline constexpr std::string_view map_page_script = R"(
const map = document.getElementById('map'), box = map.viewBox.baseVal;
map.removeAttribute('width'); map.removeAttribute('height');
const whole = {x: box.x, y: box.y, width: box.width, height: box.height};
const metres = e => new DOMPoint(e.clientX, e.clientY).matrixTransform(map.getScreenCTM().inverse());
map.addEventListener('wheel', e => {
  e.preventDefault();
  const at = metres(e), k = Math.pow(1.0015, e.deltaY);
  box.x = at.x - (at.x - box.x) * k; box.y = at.y - (at.y - box.y) * k;
  box.width *= k; box.height *= k;
}, {passive: false});
let from = null;
map.addEventListener('pointerdown', e => { from = metres(e); map.setPointerCapture(e.pointerId); });
map.addEventListener('pointermove', e => {
  if (!from) return;
  const at = metres(e);
  box.x += from.x - at.x; box.y += from.y - at.y;
});
for (const end of ['pointerup', 'pointercancel']) map.addEventListener(end, () => from = null);
const at = location.hash.match(/^#at=([-\d.]+),([-\d.]+),([\d.]+)$/);
if (at) {
  const [x, y, width] = at.slice(1).map(Number), height = width * innerHeight / innerWidth;
  Object.assign(box, {x: x - map.dataset.west - width / 2, y: map.dataset.north - y - height / 2, width, height});
}
document.getElementById('whole').onclick = () => Object.assign(box, whole);
for (const input of document.querySelectorAll('input'))
  input.onchange = () => {
    for (const layer of map.getElementsByClassName(input.name)) layer.style.display = input.checked ? '' : 'none';
  };
)";

/// A page around a map's picture, with its legend of `width` [px].
[[nodiscard]] inline std::string map_page(std::string_view title, std::string const& picture, double width,
                                          MapLegend const& legend) {
  std::string page =
      "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>" + escape_markup(title) +
      "</title>\n<style>body{margin:0;font:14px system-ui,'DejaVu Sans',sans-serif;background:#eef1ec}"
      "nav{position:fixed;top:8px;left:8px;max-width:380px;padding:8px 12px;border-radius:8px;background:#fffd;"
      "box-shadow:0 1px 4px #0003}nav label{margin-right:8px;white-space:nowrap}nav "
      "b{display:block}summary{cursor:pointer}"
      "#map{display:block;width:100vw;height:100vh;cursor:grab}</style>\n<nav><b>" +
      escape_markup(title) + "</b>";
  for (char const* layer : {"arrows", "labels", "links", "overlaps", "conflicts"})
    if (picture.find("<g class=\"" + std::string(layer) + '"') != picture.npos)
      page += std::string("<label><input type=\"checkbox\" checked name=\"") + layer + "\">" + layer + "</label>";
  page += " <button id=\"whole\">whole map</button>";
  if (!legend.text.empty())
    page += "<details open><summary>legend</summary><svg width=\"" + svg_number(width) + "\" height=\"" +
            svg_number(legend.height) + "\">" + legend.text + "</svg></details>";
  return page + "</nav>\n" + picture + "<script>" + std::string(map_page_script) + "</script></html>\n";
}

}  // namespace cambium::detail
