// The rows that make up the field table, one function a row, and the parameters that many rows share. Depends
// on table.h.
#pragma once

#include "bake/fields/table.h"

namespace nephele {

/// Cells and displacements beyond these would leave no digit of a place in its cell.
inline constexpr Range kSizeRange{1e-9, 1e9, false, false};

inline const Parameter kCellSize{
    "cell_size", ParameterType::number, "Edge of one noise cell: the size of its features.", Value{1.0},
    kSizeRange,  "world units"};
inline const Parameter kSeed{"seed",
                             ParameterType::integer,
                             "Another number, another pattern; mixed with the recipe's seed.",
                             Value{int64_t{0}},
                             {-2147483648.0, 4294967295.0, false, false}};
inline const Parameter kPeriod{"period",
                               ParameterType::integer,
                               "Cells after which the noise repeats on every axis; 0: never.",
                               Value{int64_t{0}},
                               {0.0, 1048576.0, false, false},
                               "cells"};
inline const Parameter kOctaves{"octaves",
                                ParameterType::integer,
                                "Layers of noise, each finer than the one before.",
                                Value{int64_t{5}},
                                {0.0, 16.0, false, false}};
inline const Parameter kLacunarity{"lacunarity",
                                   ParameterType::number,
                                   "How much finer each layer is.",
                                   Value{2.0},
                                   {1.0, 16.0, false, false}};
inline const Parameter kGain{
    "gain", ParameterType::number, "How much weaker each layer is.", Value{0.5}, {0.0, 1.0, true, false}};

/// Speeds and turns beyond these would leave no digit of a place or an angle.
inline constexpr Range kSpeedRange{-1e6, 1e6, false, false};
inline constexpr Range kEvolveRange{-1000.0, 1000.0, false, false};

inline const Parameter kScroll{"scroll",
                               ParameterType::vector,
                               "Speed at which the whole pattern moves.",
                               Value{std::array<double, 3>{0, 0, 0}},
                               kSpeedRange,
                               "world units per second"};
inline const Parameter kFineScroll{
    "fine_scroll",
    ParameterType::vector,
    "Speed of the last octave on top of it; octaves between move by even shares.",
    Value{std::array<double, 3>{0, 0, 0}},
    kSpeedRange,
    "world units per second"};
inline const Parameter kEvolve{
    "evolve",
    ParameterType::number,
    "How fast the pattern changes in place; each finer octave is lacunarity^(2/3) faster.",
    Value{0.0},
    kEvolveRange,
    "turns per second"};

FieldRow perlinRow();
FieldRow worleyRow();
FieldRow perlinWorleyRow();
FieldRow valueRow();
FieldRow fbmRow();
FieldRow ridgedRow();
FieldRow billowRow();
FieldRow warpRow();
FieldRow curlRow();
FieldRow transformRow();
FieldRow sphereRow();
FieldRow ellipsoidRow();
FieldRow boxRow();
FieldRow capsuleRow();
FieldRow torusRow();
FieldRow planeRow();
FieldRow meshRow();
FieldRow cauliflowerRow();
FieldRow constantRow();
FieldRow linearRow();
FieldRow exponentialRow();
FieldRow heightProfileRow();
FieldRow weatherMapRow();
FieldRow remapRow();
FieldRow addRow();
FieldRow multiplyRow();
FieldRow minRow();
FieldRow maxRow();
FieldRow mixRow();
FieldRow unionRow();
FieldRow intersectionRow();
FieldRow differenceRow();
FieldRow smoothUnionRow();

}  // namespace nephele
