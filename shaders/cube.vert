// Entry point of the method `cube`: the twelve triangles of the medium's bounding cube, each corner with its own place as a
// face coordinate. Front faces alone are drawn (glCullFace); what is behind the eye is clipped, and the cube with it.
#version 450 core
#include "dialect.glsl"
#include "shared/parameters.glsl"

layout(std140, binding = 0) uniform MarchBlock { MarchParameters params; };
layout(location = 0) uniform vec2 subPixel;
layout(location = 4) uniform vec2 pictureSize;

layout(location = 0) out vec3 faceCoordinate;  // 0…1 along each edge of the cube

// Two triangles a face, counter-clockwise seen from outside; bit 0, 1, 2 of a corner: x, y, z.
const int kCorners[36] = int[36](0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6);

void main() {
  int corner = kCorners[gl_VertexID];
  faceCoordinate = vec3(float(corner & 1), float((corner >> 1) & 1), float(corner >> 2));
  vec3 place = mix(params.boxMin.xyz, params.boxMax.xyz, faceCoordinate);
  vec3 camera = params.originCorner.xyz - params.originCorner.w * params.directionCorner.xyz;
  // place − camera = s · (directionCorner + x · dx + y · dy): s x, s y, s in pixels from the top left corner.
  vec3 picture = inverse(mat3(params.directionDx.xyz, params.directionDy.xyz, params.directionCorner.xyz)) * (place - camera);
  vec2 atCentre = picture.xy + picture.z * (vec2(0.5) - subPixel);  // the sample lies where the raster reads the pixel
  gl_Position = vec4(2.0 * atCentre / pictureSize - picture.z, 0.0, picture.z);
}
