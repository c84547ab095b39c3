#include <hdf5.h>

#include <array>
#include <stdexcept>
#include <utility>

#include "factors/csr_document.h"

namespace luxel {

namespace {

/// Why a call of HDF5 failed; becomes the reason that the writer gives.
class Failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

template <class Result>
Result checked(Result result, const char* what) {
  if (result < 0) throw Failure(std::string("HDF5 failed to ") + what);
  return result;
}

/// An identifier of HDF5 with the call that closes it.
class Handle {
 public:
  Handle(hid_t id, herr_t (*closer)(hid_t), const char* what) : id_(checked(id, what)), close_(closer) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }

  /// Closes now: what is buffered reaches the file, or the failure is known.
  void close(const char* what) { checked(close_(std::exchange(id_, -1)), what); }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// A data set of one dimension that is filled from front to back.
class Column {
 public:
  Column(hid_t file, const char* name, hid_t stored, hid_t native, std::int64_t size)
      : native_(native),
        space_(extent(size), H5Sclose, "make a data space"),
        set_(H5Dcreate2(file, name, stored, space_, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose,
             "make a data set") {}

  void append(const void* values, std::size_t count) {
    if (count == 0) return;
    const std::array<hsize_t, 1> start{written_}, length{count};
    checked(H5Sselect_hyperslab(space_, H5S_SELECT_SET, start.data(), nullptr, length.data(), nullptr),
            "select");
    const Handle memory(extent(static_cast<std::int64_t>(count)), H5Sclose, "make a data space");
    checked(H5Dwrite(set_, native_, memory, space_, H5P_DEFAULT, values), "write (is the disk full?)");
    written_ += count;
  }

 private:
  static hid_t extent(std::int64_t size) {
    const hsize_t length = static_cast<hsize_t>(size);
    return H5Screate_simple(1, &length, nullptr);
  }

  hid_t native_;
  Handle space_;
  Handle set_;
  hsize_t written_ = 0;
};

std::string write(const CsrDocument& document, const std::string& path) try {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // HDF5 would print its stack of errors
  Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose, "make the file");
  {
    const std::int64_t rows = static_cast<std::int64_t>(document.indptr.size()) - 1;
    const std::array<std::int64_t, 2> shape{rows, document.columns};
    Column(file, "shape", H5T_STD_I64LE, H5T_NATIVE_INT64, 2).append(shape.data(), 2);
    Column(file, "areas", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, rows)
        .append(document.areas.data(), document.areas.size());
    Column(file, "indptr", H5T_STD_I64LE, H5T_NATIVE_INT64, rows + 1)
        .append(document.indptr.data(), document.indptr.size());
    Column indices(file, "indices", H5T_STD_I32LE, H5T_NATIVE_INT32, document.indptr.back());
    Column data(file, "data", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, document.indptr.back());
    std::string trouble = "the rows ended early";
    const bool complete = document.pieces([&](const CsrPiece& piece) {
      try {
        indices.append(piece.indices.data(), piece.indices.size());
        data.append(piece.data.data(), piece.data.size());
        return true;
      } catch (const Failure& failure) {
        trouble = failure.what();
        return false;
      }
    });
    if (!complete) return trouble;
  }
  file.close("finish the file (is the disk full?)");
  return "";
} catch (const Failure& failure) {
  return failure.what();
}

}  // namespace

}  // namespace luxel

extern "C" [[gnu::visibility("default")]] const luxel::CsrWriter luxel_csr_writer_1 = luxel::write;
