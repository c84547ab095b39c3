#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace luxel {

/// The lines of a text one after the other; a `\` at the end of a line joins the next one to it.
class TextLines {
 public:
  /// The text must outlive this.
  explicit TextLines(std::string_view text) : rest_(text) {}

  /// Moves on to the next line. @returns false at the end of the text.
  bool next();

  /// The present line without its end; valid until next().
  std::string_view line() const { return line_; }

  /// Number of the present line in the file, from 1; of the first where several were joined.
  int number() const { return number_; }

 private:
  std::string_view take_line();

  std::string_view rest_;
  std::string_view line_;
  std::string joined_;
  int number_ = 0;
  int lines_taken_ = 0;
};

/// The words of a line, parted by blanks and tabs; a word that begins with `#` ends the line.
class LineWords {
 public:
  explicit LineWords(std::string_view line) : rest_(line) {}

  /// The next word; empty at the end of the line.
  std::string_view next();

  /// All that is left up to a comment, blanks at both ends removed.
  std::string_view rest() const;

 private:
  std::string_view rest_;
};

/// The number that a whole word spells, independent of locale; nothing where it spells none, NaN or infinity.
std::optional<double> finite_number(std::string_view word);

/// The whole number that a whole word spells; nothing where it spells none or one beyond 64 bits.
std::optional<long long> whole_number(std::string_view word);

}  // namespace luxel
