#pragma once

#include <string>
#include <string_view>

#include "cambium/core/markup.hpp"
#include "cambium/viewer/detail/map_legend.hpp"
#include "cambium/viewer/detail/map_page_script.hpp"
#include "cambium/viewer/detail/page_script.hpp"
#include "cambium/viewer/detail/svg_panel.hpp"

namespace cambium::inline v0_1::detail {

/// Style sheet of a map picture. The classes of areas are OpenDRIVE's lane types.
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

/// Style sheet of the page around the picture, with its colours in dark mode. The selector `body` gives a rule
/// precedence over the picture's own style.
inline constexpr std::string_view map_page_style = R"css(
:root {
  color-scheme: light dark;
  --page: #eef1ec; --panel: #ffffffe8; --line: #c3cbd2; --text: #101820; --soft: #55626f;
}
@media (prefers-color-scheme: dark) {
  :root { --page: #12181d; --panel: #1a222be8; --line: #35424e; --text: #e8eef5; --soft: #9aa9b8; }
  body .areas path { fill: #33413a; stroke: #12181d; }
  body .areas .driving { fill: #4b555f; } body .areas .junction { fill: #5a656f; stroke: #66717b; }
  body .areas .shoulder, body .areas .border, body .areas .stop, body .areas .curb { fill: #353f48; }
  body .areas .sidewalk, body .areas .walking { fill: #5c523f; } body .areas .biking { fill: #70503f; }
  body .areas .parking { fill: #3c4b69; }
  body .areas .bus, body .areas .taxi, body .areas .HOV { fill: #6d583f; }
  body .areas .restricted, body .areas .roadWorks { fill: #643f40; }
  body .areas .tram, body .areas .rail { fill: #55553b; }
  body .areas path:hover { fill: #2f6ea8; }
  body .arrows path { fill: #d5dee7; } body .links path { stroke: #35c77c; } body .links .tip { fill: #35c77c; }
  body .conflicts path { stroke: #f090a8; }
  body .labels text { paint-order: stroke; stroke: #12181d; stroke-width: .16px; }
}
body .ground { fill: var(--page); }
body .labels text, body .legend text { fill: var(--text); }
.marks, .rims { pointer-events: none; }
.found { fill: #ffc31f; }
.rim { fill: none; stroke: #c2410c; stroke-width: 3px; vector-effect: non-scaling-stroke; }
* { box-sizing: border-box; }
body { margin: 0; overflow: hidden; background: var(--page); color: var(--text);
  font: 14px/1.4 system-ui, 'DejaVu Sans', sans-serif; }
#map { display: block; width: 100vw; height: 100vh; height: 100dvh; cursor: grab; touch-action: none; outline: none; }
#map.dragging { cursor: grabbing; }
nav, #scale { position: fixed; background: var(--panel); border: 1px solid var(--line); border-radius: 8px; }
nav { top: 8px; left: 8px; width: 396px; max-width: calc(100vw - 16px); max-height: calc(100vh - 76px);
  overflow: auto; padding: 8px 12px; }
nav b { display: block; overflow-wrap: anywhere; }
nav label { display: inline-flex; align-items: center; gap: 4px; margin: 0 10px 4px 0; cursor: pointer; }
nav input[type=checkbox] { width: 16px; height: 16px; margin: 0; }
nav form { display: flex; gap: 6px; margin: 4px 0; }
nav input[type=search] { flex: 1; min-width: 0; font-size: 16px; }
nav input[type=search], nav button { height: 34px; padding: 0 10px; border: 1px solid var(--line); border-radius: 8px;
  background: var(--page); color: inherit; }
nav button { font: inherit; cursor: pointer; }
nav output { display: block; margin-bottom: 4px; white-space: pre-line; overflow-wrap: anywhere; }
nav output:empty { display: none; }
nav details { color: var(--soft); } nav details > svg { display: block; width: 100%; height: auto; }
summary { cursor: pointer; }
kbd { padding: 0 4px; border: 1px solid var(--line); border-radius: 4px; font: inherit; }
#scale { right: 8px; bottom: max(8px, env(safe-area-inset-bottom)); padding: 2px 10px 7px; font-size: 12px;
  text-align: center; pointer-events: none; }
#scale i { display: block; height: 5px; margin: auto; border: 1.5px solid var(--text); border-top: 0; }
:focus-visible { outline: 2px solid #1273eb; outline-offset: 1px; }
[hidden] { display: none !important; }
)css";

/// The search form for roads, lanes and junctions, and its result line.
inline constexpr std::string_view map_page_search =
    "<form role=\"search\"><input type=\"search\" id=\"find\" placeholder=\"road, road:lane or junction\" "
    "aria-label=\"Find a road, a lane or a junction by its id\" autocomplete=\"off\" spellcheck=\"false\">"
    "<button>find</button><button type=\"button\" id=\"whole\" title=\"Show the whole map (0)\">fit</button></form>"
    "<output id=\"found\" role=\"status\"></output>";

inline constexpr std::string_view map_page_keys =
    "<details id=\"keys\"><summary>keys</summary><kbd>←</kbd> <kbd>→</kbd> <kbd>↑</kbd> <kbd>↓</kbd> pan, "
    "<kbd>+</kbd> <kbd>-</kbd> zoom, <kbd>0</kbd> fits the map, <kbd>/</kbd> finds, <kbd>Esc</kbd> unmarks</details>";

/// The page around a map picture. `width`: of the legend [px].
[[nodiscard]] inline std::string map_page(std::string_view title, std::string const& picture, double width,
                                          MapLegend const& legend) {
  std::string page = page_begin(title.empty() ? "Map" : title) + std::string(map_page_style) +
                     "</style></head>\n<body><nav><b>" + escape_markup(title) + "</b>" + std::string(map_page_search);
  for (char const* layer : {"arrows", "labels", "links", "overlaps", "conflicts"})
    if (picture.find("<g class=\"" + std::string(layer) + '"') != picture.npos)
      page += std::string("<label><input type=\"checkbox\" checked name=\"") + layer + "\">" + layer + "</label>";
  if (!legend.text.empty())
    page += "<details id=\"legend\" open><summary>legend</summary><svg viewBox=\"0 0 " + svg_number(width) + ' ' +
            svg_number(legend.height) + "\">" + legend.text + "</svg></details>";
  return page + std::string(map_page_keys) + "</nav>\n" + picture +
         "<div id=\"scale\" hidden><span></span><i></i></div>\n<script>(() => {" + std::string(page_script) +
         std::string(map_page_script) + "})();</script></body></html>\n";
}

}  // namespace cambium::inline v0_1::detail
