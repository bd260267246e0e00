// Reading one asset of a recipe. Part of pipeline; depends on fields, base.
#pragma once

#include <string>

#include "bake/field_specs.h"
#include "bake/pipeline.h"

namespace nephele {

/// Reads an entry of `assets`; the files that it names are relative to `folder`.
Asset readAsset(const yaml::Entry& entry, const std::string& folder, FieldReader& fields, Diagnostics& out);

}  // namespace nephele
