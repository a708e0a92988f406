#pragma once

#include <span>
#include <string>

#include "cambium/core/macros.hpp"
#include "cambium/evaluation/rules/formula_impl.hpp"
#include "cambium/evaluation/rules/rule_monitor.hpp"

namespace cambium::detail {

CAMBIUM_COLD void refuse_label(std::string const& rule, Formula const& formula, std::string const& label,
                               std::span<std::string const> known) {
  throw FormulaError("rule '" + rule + "', formula '" + to_string(formula) + "'", "it has no label '" + label + "'",
                     known_labels(label, known));
}

}  // namespace cambium::detail
