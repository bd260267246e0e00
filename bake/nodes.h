// The field table as text for people: `nephele-bake nodes`. Depends on fields.
#pragma once

#include <string>

#include "bake/fields/table.h"

namespace nephele {

/// "number, world units, greater than 0, default 1".
std::string parameterKind(const Parameter& parameter);

/// One line a field, name first.
std::string nodesAsText();

/// One field with its parameters, defaults, ranges and units. Throws InputError for an unknown name.
std::string nodeAsText(const std::string& name);

/// Writes folder/fields.md, all of that as a page, and folder/images/fields/NAME.png, a slice through an
/// example of each field. Throws WorldError.
void writeFieldsPage(const std::string& folder);

}  // namespace nephele
