#include "linear/factor/single_threaded_blas.h"

#include <mutex>

#include "linear/factor/blas.h"

namespace luxel {

namespace {

// OpenBLAS keeps one thread count per process, so its users must be counted per process too.
struct Users {
  std::mutex mutex;
  int count = 0;
  int threads_before = 1;
};

Users& users() {
  static Users users;
  return users;
}

}  // namespace

SingleThreadedBlas::SingleThreadedBlas() {
  const std::lock_guard lock(users().mutex);
  if (users().count++ > 0) return;
  users().threads_before = openblas_get_num_threads();
  openblas_set_num_threads(1);
}

SingleThreadedBlas::~SingleThreadedBlas() {
  const std::lock_guard lock(users().mutex);
  if (--users().count == 0) openblas_set_num_threads(users().threads_before);
}

}  // namespace luxel
