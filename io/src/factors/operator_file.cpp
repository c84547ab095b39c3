#include "luxel/operator_file.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

#include "factors/checksum.h"
#include "luxel/input_error.h"
#include "luxel/write_file.h"

namespace luxel {

namespace fs = std::filesystem;

namespace {

// The file, all numbers in the machine's byte order (the mark tells which):
//   magic, byte order mark, version, precision, patches, geometry, bytes that follow the header
//   record: numbers, then enclosures; areas; diagonal; entries, the lower triangle by rows; checksum of it
//   all
constexpr std::string_view magic = "luxelK\r\n";
constexpr std::uint32_t byte_order_mark = 0x01020304;
constexpr std::uint32_t version = 1;

// Entries go through in pieces of this size [bytes]: large enough for the disk, small enough to cancel at.
constexpr std::size_t piece = std::size_t{8} << 20;

struct Header {
  char kind[8];
  std::uint32_t byte_order;
  std::uint32_t format;
  std::uint32_t precision;  // bytes an entry
  std::uint32_t patches;
  std::uint64_t geometry;
  std::uint64_t following;
};
static_assert(sizeof(Header) == 40 && std::is_trivially_copyable_v<Header>);

/// Everything of fixed size in a record, listed once for both directions.
template <class Visit>
void visit_numbers(OperatorRecord& record, const Visit& visit) {
  visit(record.options.accuracy);
  visit(record.options.visibility);
  visit(record.options.precision);
  visit(record.options.seed);
  FormFactorReport& report = record.form_factors;
  for (auto* count : {&report.pairs, &report.facing_pairs, &report.hidden_pairs, &report.partial_pairs,
                      &report.exact_pairs, &report.sampled_pairs, &report.rays}) {
    visit(*count);
  }
  visit(report.occluders);
  visit(report.estimated_error);
  ClosureReport& closure = record.closure;
  for (RowSumError* error : {&closure.before, &closure.after}) {
    for (auto* figure : {&error->max, &error->rms, &error->sampling_rms, &error->max_beyond_sampling}) {
      visit(*figure);
    }
  }
  visit(closure.largest_correction);
  visit(closure.applied);
  visit(closure.iterations);
  visit(record.enclosures.closed);
  visit(record.enclosures.count);
  visit(record.enclosures.rays);
}

/// The arrays of a record.
template <class Visit>
void visit_arrays(OperatorRecord& record, const Visit& visit) {
  visit(record.enclosures.enclosure);
  visit(record.enclosures.enclosure_closed);
  visit(record.enclosures.open_share);
  visit(record.enclosures.back_share);
  visit(record.enclosures.share_error);
  visit(record.closure.message);
}

template <class T>
std::string_view bytes_of(const T& value) {
  return {reinterpret_cast<const char*>(&value), sizeof(T)};
}

template <class Array>
std::string_view bytes_of_array(const Array& array) {
  return {reinterpret_cast<const char*>(array.data()), array.size() * sizeof(array[0])};
}

/// Tells a Progress how many bytes have passed.
class Passed {
 public:
  Passed(const Progress& progress, std::string_view stage, double total)
      : progress_(progress), stage_(stage), total_(total) {}
  void add(std::size_t bytes) {
    done_ += static_cast<double>(bytes);
    if (progress_ && !progress_(stage_, done_, total_)) throw Cancelled();
  }

 private:
  const Progress& progress_;
  std::string_view stage_;
  double total_, done_ = 0;
};

class Writer {
 public:
  Writer(const fs::path& path, const Progress& progress, double total)
      : file_(path), passed_(progress, "save", total) {}
  void write(std::string_view bytes) {
    while (!bytes.empty()) {
      const std::string_view part = bytes.substr(0, piece);
      checksum_.add(part);
      file_.write(part);
      passed_.add(part.size());
      bytes.remove_prefix(part.size());
    }
  }
  void finish() {
    const std::uint64_t sum = checksum_.value();
    file_.write(bytes_of(sum));
    file_.commit();
  }

 private:
  OutputFile file_;
  Passed passed_;
  Checksum checksum_;
};

class Reader {
 public:
  Reader(const fs::path& path, const Progress& progress)
      : path_(path), progress_(progress), file_(path, std::ios::binary) {
    std::error_code error;
    if (fs::is_directory(path, error)) fail("is a folder; a saved operator was expected");
    if (!file_) fail(std::string("cannot be read: ") + std::generic_category().message(errno));
    size_ = fs::file_size(path, error);
    if (error) fail("cannot be read: " + error.message());
  }
  [[noreturn]] void fail(const std::string& what) const { throw InputError(path_.string() + ": " + what); }
  std::uint64_t size() const { return size_; }

  void read(char* to, std::size_t count) {
    while (count > 0) {
      const std::size_t part = std::min(count, piece);
      if (!file_.read(to, static_cast<std::streamsize>(part)))
        fail("ends too early: the saved operator is cut off");
      checksum_.add({to, part});
      done_ += static_cast<double>(part);
      if (progress_ && !progress_("load", done_, static_cast<double>(size_))) throw Cancelled();
      to += part;
      count -= part;
    }
  }
  template <class T>
  void read(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    read(reinterpret_cast<char*>(&value), sizeof(T));
  }
  template <class Array>
  void read_array(Array& array) {
    std::uint64_t count = 0;
    read(count);
    if (count > size_ / sizeof(array[0])) fail_damaged();
    array.resize(count);
    read(reinterpret_cast<char*>(array.data()), count * sizeof(array[0]));
  }
  void check_sum() {
    const std::uint64_t expected = checksum_.value();
    std::uint64_t found = 0;
    read(found);
    if (found != expected) fail_damaged();
  }
  [[noreturn]] void fail_damaged() const { fail("is damaged: its checksum does not fit its content"); }

 private:
  fs::path path_;
  const Progress& progress_;
  std::ifstream file_;
  std::uint64_t size_ = 0;
  double done_ = 0;
  Checksum checksum_;
};

const char* entry_data(const ExchangeMatrix& matrix) {
  return matrix.precision() == Precision::float32 ? reinterpret_cast<const char*>(matrix.row<float>(0))
                                                  : reinterpret_cast<const char*>(matrix.row<double>(0));
}

/// Whether the file is a saved operator that this program reads, whole, of this mesh.
Header checked_header(Reader& reader, const PatchMesh& mesh) {
  Header header{};
  if (reader.size() < sizeof(Header)) reader.fail("is not a saved operator of Luxel: it is too short");
  reader.read(header);
  if (std::string_view(header.kind, sizeof(header.kind)) != magic)
    reader.fail("is not a saved operator of Luxel");
  if (header.byte_order != byte_order_mark) reader.fail("was saved on a machine of the other byte order");
  if (header.format != version) {
    reader.fail("has version " + std::to_string(header.format) +
                " of the format; this program reads version " + std::to_string(version));
  }
  const std::uint64_t whole = sizeof(Header) + header.following;
  if (reader.size() != whole) {
    reader.fail("has " + std::to_string(reader.size()) + " bytes where " + std::to_string(whole) +
                " were saved: it is cut off or something was added");
  }
  if (header.precision != 4 && header.precision != 8) reader.fail_damaged();
  if (header.patches != static_cast<std::uint32_t>(mesh.size()) || header.geometry != geometry_hash(mesh)) {
    reader.fail("was saved for another mesh (" + std::to_string(header.patches) + " patches) than that of " +
                mesh.file + " (" + std::to_string(mesh.size()) + " patches), or the mesh has changed since");
  }
  const std::uint64_t entries = ExchangeMatrix::offset(mesh.size());
  if (entries * header.precision > header.following) reader.fail_damaged();
  return header;
}

}  // namespace

void save_operator(const fs::path& path, const PatchMesh& mesh, const DenseOperator& transport,
                   const OperatorRecord& original, const Progress& progress) {
  if (transport.size() != mesh.size()) {
    throw std::invalid_argument("save_operator: the operator has another number of patches than the mesh");
  }
  const ExchangeMatrix& entries = *transport.entries();
  OperatorRecord record = original;
  Header header{};
  magic.copy(header.kind, sizeof(header.kind));
  header.byte_order = byte_order_mark;
  header.format = version;
  header.precision = entries.precision() == Precision::float32 ? 4 : 8;
  header.patches = static_cast<std::uint32_t>(mesh.size());
  header.geometry = geometry_hash(mesh);
  header.following =
      sizeof(std::uint64_t) + entries.bytes() + 2 * (sizeof(std::uint64_t) + sizeof(double) * mesh.size());
  visit_numbers(record, [&](const auto& number) { header.following += sizeof(number); });
  visit_arrays(record, [&](const auto& array) {
    header.following += sizeof(std::uint64_t) + array.size() * sizeof(array[0]);
  });

  Writer writer(path, progress, static_cast<double>(header.following));
  const auto write_array = [&](const auto& array) {
    const std::uint64_t count = array.size();
    writer.write(bytes_of(count));
    writer.write(bytes_of_array(array));
  };
  writer.write(bytes_of(header));
  visit_numbers(record, [&](const auto& number) { writer.write(bytes_of(number)); });
  visit_arrays(record, write_array);
  write_array(transport.areas());
  write_array(transport.diagonal());
  writer.write({entry_data(entries), entries.bytes()});
  writer.finish();
}

SavedOperator load_operator(const fs::path& path, const PatchMesh& mesh, const Progress& progress) {
  Reader reader(path, progress);
  const Header header = checked_header(reader, mesh);
  SavedOperator saved;
  visit_numbers(saved.record, [&](auto& number) { reader.read(number); });
  visit_arrays(saved.record, [&](auto& array) { reader.read_array(array); });
  std::vector<double> areas, diagonal;
  reader.read_array(areas);
  reader.read_array(diagonal);
  const std::size_t patches = header.patches;
  if (areas.size() != patches || diagonal.size() != patches) reader.fail_damaged();
  ExchangeMatrix entries(mesh.size(), header.precision == 4 ? Precision::float32 : Precision::float64);
  reader.read(const_cast<char*>(entry_data(entries)), entries.bytes());
  reader.check_sum();
  if (saved.record.enclosures.enclosure.size() != patches) reader.fail_damaged();
  saved.transport =
      std::make_unique<DenseOperator>(std::move(entries), std::move(areas), std::move(diagonal));
  return saved;
}

}  // namespace luxel
