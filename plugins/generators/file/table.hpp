#pragma once
// A CSV file as rows of cells, with the line each row stands on.
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace csv {

struct Row {
  std::size_t line = 0;
  std::vector<std::string_view> cells;
};

/// Header and rows of a text; the cells refer into it. Blank lines and lines that begin with '#' are skipped, spaces
/// around a cell are dropped, line ends may be LF or CRLF. Throws on a ragged row, with the line.
class Table {
 public:
  Table(std::string_view text, const std::string& path);
  const Row& header() const { return header_; }
  const std::vector<Row>& rows() const { return rows_; }
  /// Throws "PATH:LINE: why".
  [[noreturn]] void refuse(std::size_t line, const std::string& why) const;

 private:
  std::string path_;
  Row header_;
  std::vector<Row> rows_;
};

/// The whole file; throws with the reason of the system.
std::string read_file(const std::string& path);

}  // namespace csv
