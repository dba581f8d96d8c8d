#include "table.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace csv {
namespace {

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t begin = 0;;) {
    const std::size_t comma = line.find(',', begin);
    cells.push_back(trimmed(line.substr(begin, comma == std::string_view::npos ? comma : comma - begin)));
    if (comma == std::string_view::npos) return cells;
    begin = comma + 1;
  }
}

}  // namespace

Table::Table(std::string_view text, const std::string& path) : path_(path) {
  if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);
  std::size_t line = 0;
  while (!text.empty()) {
    ++line;
    const std::size_t end = text.find('\n');
    const std::string_view content = trimmed(text.substr(0, end));
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    if (content.empty() || content.front() == '#') continue;
    Row row{line, split(content)};
    if (header_.cells.empty()) {
      header_ = std::move(row);
      continue;
    }
    if (row.cells.size() != header_.cells.size())
      refuse(line, "has " + std::to_string(row.cells.size()) + " cells, the header has " +
                       std::to_string(header_.cells.size()));
    rows_.push_back(std::move(row));
  }
  if (header_.cells.empty()) refuse(1, "the file is empty; it must begin with a header such as x,y,z,radius");
}

void Table::refuse(std::size_t line, const std::string& why) const {
  throw std::runtime_error(path_ + ":" + std::to_string(line) + ": " + why);
}

std::string read_file(const std::string& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string text;
  char block[1 << 16];
  while (file) {
    file.read(block, sizeof block);
    text.append(block, static_cast<std::size_t>(file.gcount()));
  }
  if (!file.eof() || file.bad())
    throw std::runtime_error("cannot read '" + path + "': " + (errno != 0 ? std::strerror(errno) : "input error"));
  return text;
}

}  // namespace csv
