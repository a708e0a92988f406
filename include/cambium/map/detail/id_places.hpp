#pragma once

#include <cstddef>
#include <string_view>
#include <unordered_map>

namespace cambium::map::detail {

/// Where elements of a document are, by their ids, which must live as long. One type for all that look ids up.
using IdPlaces = std::unordered_map<std::string_view, std::size_t>;

}  // namespace cambium::map::detail
