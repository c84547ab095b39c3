#include "scene/ply_numbers.h"

#include <cmath>

#include "scene/binary_numbers.h"
#include "scene/input_location.h"

namespace luxel {
namespace {

std::size_t size_of(PlyNumber type) {
  switch (type) {
    case PlyNumber::Int8:
    case PlyNumber::Uint8:
      return 1;
    case PlyNumber::Int16:
    case PlyNumber::Uint16:
      return 2;
    case PlyNumber::Int32:
    case PlyNumber::Uint32:
    case PlyNumber::Float32:
      return 4;
    case PlyNumber::Float64:
      break;
  }
  return 8;
}

double number_of(std::string_view bytes, PlyNumber type, std::endian order) {
  switch (type) {
    case PlyNumber::Int8:
      return number_at<std::int8_t>(bytes, 0, order);
    case PlyNumber::Uint8:
      return number_at<std::uint8_t>(bytes, 0, order);
    case PlyNumber::Int16:
      return number_at<std::int16_t>(bytes, 0, order);
    case PlyNumber::Uint16:
      return number_at<std::uint16_t>(bytes, 0, order);
    case PlyNumber::Int32:
      return number_at<std::int32_t>(bytes, 0, order);
    case PlyNumber::Uint32:
      return number_at<std::uint32_t>(bytes, 0, order);
    case PlyNumber::Float32:
      return number_at<float>(bytes, 0, order);
    case PlyNumber::Float64:
      break;
  }
  return number_at<double>(bytes, 0, order);
}

}  // namespace

PlyNumbers::PlyNumbers(const std::filesystem::path& file, std::string_view bytes, const PlyHeader& header)
    : file_(file),
      rest_(bytes.substr(header.bytes)),
      format_(header.format),
      lines_(rest_),
      header_lines_(header.lines) {}

void PlyNumbers::fail(const std::string& message) const {
  refuse({file_, format_ == PlyHeader::Format::Text ? header_lines_ + lines_.number() : 0}, message);
}

void PlyNumbers::begin_element() {
  if (format_ != PlyHeader::Format::Text) return;
  do {
    if (!lines_.next()) fail("the file ends; expected more elements");
    words_ = LineWords(lines_.line());
  } while (LineWords(words_).next().empty());
}

double PlyNumbers::next(PlyNumber type) {
  if (format_ == PlyHeader::Format::Text) return next_word();
  const std::size_t size = size_of(type);
  if (rest_.size() < size) fail("the file is cut off; expected more elements");
  const auto order = format_ == PlyHeader::Format::LittleEndian ? std::endian::little : std::endian::big;
  const double number = number_of(rest_, type, order);
  if (!std::isfinite(number)) fail("a number that is not finite");
  rest_.remove_prefix(size);
  return number;
}

double PlyNumbers::next_word() {
  const std::string_view word = words_.next();
  const std::optional<double> number = finite_number(word);
  if (!number)
    fail(word.empty() ? "too few numbers" : "found " + in_quotes(word) + "; expected a finite number");
  return *number;
}

}  // namespace luxel
