#pragma once

#include <filesystem>
#include <string_view>

#include "scene/ply_header.h"
#include "scene/text_lines.h"

namespace luxel {

/// The numbers of a PLY file after its header, one after the other, text or binary.
class PlyNumbers {
 public:
  /// The bytes of the whole file must outlive this.
  PlyNumbers(const std::filesystem::path& file, std::string_view bytes, const PlyHeader& header);

  /// @throws InputError if the file ends, or the next word is no finite number.
  double next(PlyNumber type);

  /// "file:line: message" in text, "file: message" in binary. @throws InputError always.
  [[noreturn]] void fail(const std::string& message) const;

  /// In text an element begins on a line of its own; nothing to do in binary.
  void begin_element();

 private:
  double next_word();

  std::filesystem::path file_;
  std::string_view rest_;
  PlyHeader::Format format_;
  TextLines lines_;
  LineWords words_{""};
  int header_lines_;
};

}  // namespace luxel
