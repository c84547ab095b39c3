#include "luxel/write_csv.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <vector>

#include "luxel/write_file.h"

namespace luxel {

namespace {

constexpr std::string_view header =
    "patch,face,group,material,area,cx,cy,cz,nx,ny,nz,E_r,E_g,E_b,H_r,H_g,H_b,B_r,B_g,B_b\n";

// The digits of a number that is not asked for in full
constexpr int significant_digits = 9;

// Rows that one task formats: some 2 MB of text, far above the cost of starting a task
constexpr int rows_per_block = 8192;

// Blocks formatted before they are written in order: enough for many cores, little memory
constexpr int blocks_per_wave = 8;

void append(std::string& text, int number) {
  char digits[16];
  const auto end = std::to_chars(digits, digits + sizeof digits, number).ptr;
  text.append(digits, end);
}

void append(std::string& text, double number, bool full_precision) {
  char digits[32];
  const auto end = full_precision ? std::to_chars(digits, digits + sizeof digits, number).ptr
                                  : std::to_chars(digits, digits + sizeof digits, number,
                                                  std::chars_format::general, significant_digits)
                                        .ptr;
  text.push_back(',');
  text.append(digits, end);
}

std::vector<std::string> csv_fields(const std::vector<std::string>& names) {
  std::vector<std::string> fields(names.size());
  std::transform(names.begin(), names.end(), fields.begin(), csv_field);
  return fields;
}

void require_three_columns(const PatchField& field, const PatchMesh& mesh, const char* what) {
  if (field.rows() != mesh.size() || field.cols() != 3) {
    throw std::invalid_argument(std::string("write_csv: ") + what + " is not one row per patch by 3");
  }
}

}  // namespace

std::string csv_field(std::string_view text) {
  const bool plain = text.find_first_of(",\"\r\n") == std::string_view::npos &&
                     (text.empty() || (text.front() != ' ' && text.back() != ' '));
  if (plain) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted.push_back('"');
    quoted.push_back(c);
  }
  quoted.push_back('"');
  return quoted;
}

void write_csv(const std::filesystem::path& path, const PatchMesh& mesh, const RadiositySolution& solution,
               const CsvOptions& options) {
  require_three_columns(solution.radiosity, mesh, "radiosity");
  require_three_columns(solution.irradiance, mesh, "irradiance");
  const auto groups = csv_fields(mesh.group_names);
  const auto materials = csv_fields(mesh.material_names);
  const auto append_row = [&](std::string& text, int i) {
    const auto append_three = [&](const auto& values) {
      for (int k = 0; k < 3; ++k) append(text, values[k], options.full_precision);
    };
    append(text, i);
    text.push_back(',');
    append(text, mesh.faces[i]);
    text.append(",").append(groups[mesh.groups[i]]).append(",").append(materials[mesh.materials[i]]);
    append(text, mesh.areas[i], options.full_precision);
    append_three(mesh.centroids[i]);
    append_three(mesh.normals[i]);
    append_three(mesh.finish_table[mesh.finishes[i]].emission);
    append_three(solution.irradiance.row(i));
    append_three(solution.radiosity.row(i));
    text.push_back('\n');
  };

  OutputFile file(path);
  file.write(header);
  std::vector<std::string> blocks(blocks_per_wave);
  for (int start = 0; start < mesh.size(); start += blocks_per_wave * rows_per_block) {
    tbb::parallel_for(0, blocks_per_wave, [&](int block) {
      blocks[block].clear();
      const int first = std::min(mesh.size(), start + block * rows_per_block);
      const int last = std::min(mesh.size(), first + rows_per_block);
      for (int i = first; i < last; ++i) append_row(blocks[block], i);
    });
    for (const std::string& block : blocks) file.write(block);
  }
  file.commit();
}

}  // namespace luxel
