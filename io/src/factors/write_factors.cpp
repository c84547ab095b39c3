#include "luxel/write_factors.h"

#include <tbb/parallel_for.h>

#include <array>
#include <charconv>
#include <exception>
#include <numeric>
#include <string>
#include <vector>

#include "factors/csr_document.h"
#include "factors/factor_bands.h"
#include "luxel/input_error.h"
#include "luxel/write_file.h"
#include "output/module.h"

namespace luxel {

namespace fs = std::filesystem;

namespace {

constexpr int short_digits = 9, full_digits = 17;

/// Tells how far the rows are; @throws Cancelled
void tell(const Progress& progress, const FactorBand& band) {
  if (progress && !progress("write factors", band.first + band.rows, band.columns)) throw Cancelled();
}

void append(std::string& text, std::int64_t number) {
  std::array<char, 24> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
  text.append(digits.data(), end);
}

void append(std::string& text, double number, int significant) {
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number,
                                 std::chars_format::general, significant)
                       .ptr;
  text.append(digits.data(), end);
}

/// Lines `i<separator>j<separator>F` of every factor that is not 0, counted from `base`.
void write_lines(OutputFile& file, const DenseOperator& transport, char separator, int base, int significant,
                 const Progress& progress) {
  std::vector<std::string> rows;
  for_each_band(transport, [&](const FactorBand& band) {
    rows.resize(band.rows);
    tbb::parallel_for(0, band.rows, [&](int k) {
      std::string& text = rows[k];
      text.clear();
      std::string start;
      append(start, band.first + k + base);
      start += separator;
      const auto row = band.row(k);
      for (int j = 0; j < band.columns; ++j) {
        if (row[j] == 0) continue;
        text += start;
        append(text, j + base);
        text += separator;
        append(text, row[j], significant);
        text += '\n';
      }
    });
    for (const std::string& text : rows) file.write(text);
    tell(progress, band);
  });
}

void write_matrix_market(const fs::path& path, const DenseOperator& transport, int significant,
                         const Progress& progress) {
  OutputFile file(path);
  const std::vector<std::int64_t> counts = entries_by_row(transport);
  std::string head =
      "%%MatrixMarket matrix coordinate real general\n"
      "% form factors F_ij: share of what leaves patch i that arrives at patch j, patches counted from 1\n";
  append(head, transport.size());
  head += ' ';
  append(head, transport.size());
  head += ' ';
  append(head, std::accumulate(counts.begin(), counts.end(), std::int64_t{0}));
  head += '\n';
  file.write(head);
  write_lines(file, transport, ' ', 1, significant, progress);
  file.commit();
}

void write_csv(const fs::path& path, const DenseOperator& transport, int significant,
               const Progress& progress) {
  OutputFile file(path);
  file.write("i,j,F\n");
  write_lines(file, transport, ',', 0, significant, progress);
  file.commit();
}

/// The entries of a band that are not 0, in place of what the vectors held.
void take_entries(const FactorBand& band, std::vector<std::int32_t>& indices, std::vector<double>& data) {
  indices.clear();
  data.clear();
  for (int k = 0; k < band.rows; ++k) {
    const auto row = band.row(k);
    for (int j = 0; j < band.columns; ++j) {
      if (row[j] == 0) continue;
      indices.push_back(j);
      data.push_back(row[j]);
    }
  }
}

void write_hdf5(const fs::path& path, const DenseOperator& transport, const Progress& progress) {
  const auto write = *static_cast<const CsrWriter*>(module_symbol("luxel_hdf5", csr_writer_symbol, path));
  OutputFile file(path);
  const std::vector<std::int64_t> counts = entries_by_row(transport);
  std::vector<std::int64_t> indptr(counts.size() + 1, 0);
  std::partial_sum(counts.begin(), counts.end(), indptr.begin() + 1);

  CsrDocument document;
  document.indptr = indptr;
  document.areas = transport.areas();
  document.columns = transport.size();
  std::exception_ptr interruption;
  document.pieces = [&](const std::function<bool(const CsrPiece&)>& take) {
    struct NotTaken {};
    std::vector<std::int32_t> indices;
    std::vector<double> data;
    try {
      for_each_band(transport, [&](const FactorBand& band) {
        take_entries(band, indices, data);
        if (!take({indices, data})) throw NotTaken();
        tell(progress, band);
      });
      return true;
    } catch (NotTaken) {
    } catch (...) {
      interruption = std::current_exception();
    }
    return false;
  };
  const std::string reason = write(document, file.working_path().string());
  if (interruption) std::rethrow_exception(interruption);
  if (!reason.empty()) throw InputError(path.string() + ": cannot be written: " + reason);
  file.commit();
}

}  // namespace

void write_factors(const fs::path& path, const DenseOperator& transport, const FactorFileOptions& options,
                   const Progress& progress) {
  const int significant = options.full_precision ? full_digits : short_digits;
  const std::string extension = path.extension().string();
  if (extension == ".mtx") return write_matrix_market(path, transport, significant, progress);
  if (extension == ".csv") return write_csv(path, transport, significant, progress);
  if (extension == ".h5") return write_hdf5(path, transport, progress);
  throw InputError(path.string() + ": form factors are written as .mtx, .csv or .h5, not as '" + extension +
                   "'");
}

}  // namespace luxel
