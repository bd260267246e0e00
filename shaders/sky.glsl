// The lat-long picture as textures, and how the shared text reads them. Included after the parameters.
layout(binding = 8) uniform sampler2D skyTexels;  // row 0 at the top
layout(binding = 9) uniform sampler2D skyCells;   // the table of directions, kSkyCellsAround × kSkyCellsUp

vec3 environmentTexel(ivec2 texel) { return texelFetch(skyTexels, texel, 0).rgb; }
vec4 environmentCell(int cell) { return texelFetch(skyCells, ivec2(cell & 255, cell >> 8), 0); }
