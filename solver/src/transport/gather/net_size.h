#pragma once

namespace luxel {

/// Rays of one patch, at least and at most.
constexpr int least_rays = 16, most_rays = 1 << 20;

/// The least of 2^k and 3 2^k in [least_rays, most_rays] that is not below x: whole nets of the sequence.
constexpr int net_size(double x) {
  int size = least_rays;
  while (size < x && size < most_rays) {
    if (size + size / 2 >= x) return size + size / 2;
    size *= 2;
  }
  return size;
}

/// The largest of them that is not above x.
constexpr int net_within(double x) {
  int size = least_rays;
  while (net_size(size + 1) <= x && size < most_rays) size = net_size(size + 1);
  return size;
}

}  // namespace luxel
