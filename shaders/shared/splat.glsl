// What a particle gives to the voxels round it: the kernels of the bake's splat, one voxel at a time. Included after math.

NPH_CONST int kSplatGaussian = 0;
NPH_CONST int kSplatWendland = 1;
NPH_CONST int kSplatSmoothSphere = 2;

// A kernel at a squared distance in radii; 0 from 1 on. The Gaussian ends at three standard deviations.
NPH_FN float splatKernel(int kernel, float squared) {
  if (kernel == kSplatGaussian) return squared < 1.0f ? exponential(-4.5f * squared) : 0.0f;
  if (kernel == kSplatWendland) {  // (1 − q)⁴ (4q + 1) [Wendland 1995, C2]
    float q = sqrt(squared);
    float t = max(1.0f - q, 0.0f);
    return t * t * (t * t) * (4.0f * q + 1.0f);
  }
  // 1 up to half the radius, then s² (3 − 2s), s = (1 − q²)/(3/4).
  float s = min(max((1.0f - squared) * (4.0f / 3.0f), 0.0f), 1.0f);
  return s * s * (3.0f - 2.0f * s);
}

// The weight, not normalised, of a voxel that lies `apart` voxels from a particle of `radius` voxels. One of a voxel's radius or
// less is shared out by trilinear weights; the Gaussian ends on the faces of a cube.
NPH_FN float splatWeight(int kernel, vec3 apart, float radius) {
  if (radius <= 1.0f) {
    vec3 nearness = max(vec3(1.0f) - abs(apart), vec3(0.0f));
    return nearness.x * nearness.y * nearness.z;
  }
  float perSquare = 1.0f / (radius * radius);
  if (kernel == kSplatGaussian)
    return splatKernel(kernel, apart.x * apart.x * perSquare) * splatKernel(kernel, apart.y * apart.y * perSquare) *
           splatKernel(kernel, apart.z * apart.z * perSquare);
  return splatKernel(kernel, dot(apart, apart) * perSquare);
}

// The same for a particle that is drawn along a line, centred, `stretch` voxels long; it is at least a voxel in radius.
NPH_FN float splatStretched(int kernel, vec3 apart, float radius, vec3 stretch) {
  float along = dot(stretch, stretch);
  if (along == 0.0f) return splatWeight(kernel, apart, radius);
  float wide = max(radius, 1.0f);
  vec3 aside = apart - stretch * clamp(dot(apart, stretch) / along, -0.5f, 0.5f);
  return splatKernel(kernel, dot(aside, aside) / (wide * wide));
}

// ∫ of the kernel over a ball of radius 1, and over a disc of radius 1.
NPH_FN vec2 splatIntegrals(int kernel) {
  if (kernel == kSplatGaussian) return vec2(0.56623296f, 0.69037616f);
  if (kernel == kSplatWendland) return vec2(0.29919930f, 0.44879895f);  // 2π/21, π/7
  return vec2(2.12616194f, 1.96349541f);
}

// Σ of the weights of a particle that is many voxels wide: an integral in place of the sum.
NPH_FN float splatWideSum(int kernel, float radius, vec3 stretch) {
  vec2 integrals = splatIntegrals(kernel);
  return radius * radius * (radius * integrals.x + length(stretch) * integrals.y);
}
