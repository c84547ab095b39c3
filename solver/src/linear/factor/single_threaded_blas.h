#pragma once

namespace luxel {

/// Keeps OpenBLAS to the calling thread while any of these lives, in any thread. Its own threads give other
/// bits for other thread counts (measured with 0.3.21: spotrf, sgetrf and sgemv of 1 and 2 threads differ);
/// we share the work out ourselves, over tiles that do not depend on the number of threads.
class SingleThreadedBlas {
 public:
  SingleThreadedBlas();
  ~SingleThreadedBlas();
  SingleThreadedBlas(const SingleThreadedBlas&) = delete;
  SingleThreadedBlas& operator=(const SingleThreadedBlas&) = delete;
};

}  // namespace luxel
