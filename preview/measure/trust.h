// Where a method errs too much, said before the user sees it: a scene's facts looked up in the stability map.
// Depends on preview/measure alone.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "preview/measure/scene_facts.h"
#include "preview/measure/stability.h"

namespace nephele {

/// One measured place on an axis of the map: where its case lies by its facts, and the relative RMSE there.
struct TrustRow {
  std::string_view way, axis;
  double fact, error;
};

/// What `chart --stability` measured when preview/measure/stability_table.inc was made of it.
std::span<const TrustRow> trustTable();

/// The way of the map that a method goes with a scene's light; empty where the map has none (`reference`).
std::string wayFor(std::string_view method, const SceneFacts& facts, const ViewedScene& view);

/// A sentence for each axis on which a scene lies where the way errs by more than 1.2 kTrustedError, as the
/// map has it between its places: "march: sheet thinner than a step; error up to 12%". Of two axes that speak
/// of the same things the worse one is named.
std::vector<std::string> trustWarnings(std::string_view method, const SceneFacts& facts,
                                       const ViewedScene& view, std::span<const TrustRow> table);

/// The table's rows for what a run measured, as the text of stability_table.inc: the axes that warnings read.
std::string trustRowsAsText(const StabilityResult& result);

/// A case's place on its axis; NaN where no warning reads the axis.
double factOf(const std::string& axis, const SceneFacts& facts);

}  // namespace nephele
