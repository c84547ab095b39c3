#include "scene/text_lines.h"

#include <charconv>
#include <cmath>

namespace luxel {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

std::string_view without_plus(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  return word;
}

}  // namespace

std::string_view TextLines::take_line() {
  const std::size_t end = rest_.find('\n');
  std::string_view line = rest_.substr(0, end);
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  ++lines_taken_;
  return line;
}

bool TextLines::next() {
  if (rest_.empty()) return false;
  line_ = take_line();
  number_ = lines_taken_;
  if (line_.empty() || line_.back() != '\\') return true;

  joined_.clear();
  while (!line_.empty() && line_.back() == '\\') {
    joined_ += line_.substr(0, line_.size() - 1);
    joined_ += ' ';
    line_ = rest_.empty() ? std::string_view() : take_line();
  }
  joined_ += line_;
  line_ = joined_;
  return true;
}

std::string_view LineWords::next() {
  std::size_t begin = 0;
  while (begin < rest_.size() && is_blank(rest_[begin])) ++begin;
  if (begin == rest_.size() || rest_[begin] == '#') {
    rest_ = {};
    return {};
  }
  std::size_t end = begin;
  while (end < rest_.size() && !is_blank(rest_[end])) ++end;
  const std::string_view word = rest_.substr(begin, end - begin);
  rest_.remove_prefix(end);
  return word;
}

std::string_view LineWords::rest() const {
  LineWords words(rest_);
  const std::string_view first = words.next();
  if (first.empty()) return {};
  const char* end = first.data() + first.size();
  for (std::string_view word = words.next(); !word.empty(); word = words.next())
    end = word.data() + word.size();
  return {first.data(), static_cast<std::size_t>(end - first.data())};
}

std::optional<double> finite_number(std::string_view word) {
  word = without_plus(word);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size()) return std::nullopt;
  // Too small for a double, such as 1e-400, is 0; too large is no number that we can use.
  if (error == std::errc::result_out_of_range && word.find_first_of("eE") != std::string_view::npos) {
    const std::size_t exponent = word.find_first_of("eE") + 1;
    if (exponent < word.size() && word[exponent] == '-') return 0.0;
    return std::nullopt;
  }
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<long long> whole_number(std::string_view word) {
  word = without_plus(word);
  long long value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

}  // namespace luxel
