// The field table as text for people: `nephele-bake nodes`. Depends on fields.
#pragma once

#include <string>

namespace nephele {

/// One line a field, name first.
std::string nodesAsText();

/// One field with its parameters, defaults, ranges and units. Throws InputError for an unknown name.
std::string nodeAsText(const std::string& name);

}  // namespace nephele
