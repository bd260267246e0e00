// Temperatures as textures, laid out as the densities are. Included after bricks.glsl.
layout(binding = 10) uniform sampler3D heatAtlas;
layout(binding = 11) uniform usampler2D heatIndex;

uvec2 heatWord(ivec3 brick) { return wordAt(heatIndex, params.heatCount.xyz, brick).rg; }
float heatValue(uvec2 word, vec3 position) { return brickValue(heatAtlas, word, position); }
