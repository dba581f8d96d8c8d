#pragma once
// Reads C++ sources as far as house rules need it: includes, string constants, and the code without comments.
#include <algorithm>
#include <cctype>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace scree::test {

struct SourceFile {
  std::string path;      // relative to the root, with '/'
  std::string code;      // comments blanked, string constants emptied; line breaks kept
  std::string comments;  // only the comments; line breaks kept
  std::vector<std::string> strings, includes;
  std::size_t lines = 0;
};

// The text of an include line between its quotes or angle brackets; "" for any other line.
inline std::string included(const std::string& line) {
  std::size_t at = line.find_first_not_of(" \t");
  if (at == std::string::npos || line[at] != '#') return "";
  at = line.find_first_not_of(" \t", at + 1);
  if (at == std::string::npos || line.compare(at, 7, "include") != 0) return "";
  const std::size_t open = line.find_first_of("<\"", at + 7);
  if (open == std::string::npos) return "";
  const std::size_t close = line.find(line[open] == '<' ? '>' : '"', open + 1);
  return close == std::string::npos ? "" : line.substr(open + 1, close - open - 1);
}

// Takes one source text apart, character by character.
class Scanner {
 public:
  explicit Scanner(const std::string& text) : text_(text) {}

  SourceFile scan() {
    while (at_ < text_.size()) {
      if (starts("//")) {
        comment("\n", 0);
      } else if (starts("/*")) {
        comment("*/", 2);
      } else if (starts("R\"") && !in_name()) {
        raw_string();
      } else if (text_[at_] == '"') {
        string();
      } else if (text_[at_] == '\'' && !in_name()) {
        character();
      } else {
        keep(out_.code);
      }
    }
    std::istringstream lines(text_);
    for (std::string line; std::getline(lines, line); ++out_.lines)
      if (const std::string name = included(line); !name.empty()) out_.includes.push_back(name);
    return out_;
  }

 private:
  bool starts(const char* what) const { return text_.compare(at_, std::char_traits<char>::length(what), what) == 0; }
  // A quote after a letter or digit is a digit separator, an R after one the end of a name.
  bool in_name() const {
    return at_ > 0 && (std::isalnum(static_cast<unsigned char>(text_[at_ - 1])) || text_[at_ - 1] == '_');
  }
  void keep(std::string& where) {
    if (text_[at_] == '\n') {
      out_.code += '\n';
      out_.comments += '\n';
    } else {
      where += text_[at_];
    }
    ++at_;
  }
  void comment(const char* end, std::size_t size) {
    const std::size_t stop = std::min(text_.find(end, at_ + size), text_.size() - size);
    while (at_ < stop + size) keep(out_.comments);
  }
  void raw_string() {
    const std::size_t open = text_.find('(', at_);
    const std::string end = ")" + text_.substr(at_ + 2, open - at_ - 2) + "\"";
    const std::size_t close = text_.find(end, open);
    out_.strings.push_back(text_.substr(open + 1, close - open - 1));
    out_.code += "\"\"";
    at_ = close + end.size();
  }
  void string() {
    std::string value;
    for (++at_; at_ < text_.size() && text_[at_] != '"'; ++at_) {
      if (text_[at_] == '\\') value += text_[at_++];
      value += text_[at_];
    }
    ++at_;
    out_.strings.push_back(value);
    out_.code += "\"\"";
  }
  void character() {
    for (++at_; at_ < text_.size() && text_[at_] != '\''; ++at_)
      if (text_[at_] == '\\') ++at_;
    ++at_;
    out_.code += "' '";
  }

  std::string text_;
  std::size_t at_ = 0;
  SourceFile out_;
};

inline SourceFile scan_text(const std::string& text) { return Scanner(text).scan(); }

// All .cpp, .hpp and .h files below the named folders of the root, in the order of their names.
inline std::vector<SourceFile> scan_folders(const std::filesystem::path& root,
                                            const std::vector<std::string>& folders) {
  std::vector<std::filesystem::path> paths;
  for (const std::string& folder : folders) {
    if (!std::filesystem::is_directory(root / folder)) continue;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
      const std::string kind = entry.path().extension().string();
      if (entry.is_regular_file() && (kind == ".cpp" || kind == ".hpp" || kind == ".h")) paths.push_back(entry.path());
    }
  }
  std::sort(paths.begin(), paths.end());
  std::vector<SourceFile> files;
  for (const auto& path : paths) {
    std::ifstream in(path);
    std::ostringstream text;
    text << in.rdbuf();
    files.push_back(scan_text(text.str()));
    files.back().path = path.lexically_relative(root).generic_string();
  }
  return files;
}

}  // namespace scree::test
