#include "core/scene/load.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>
#include <unordered_map>
#include <unordered_set>

namespace scree::core {
namespace {

/// Ends the reading of a file: what follows cannot be trusted.
struct Stop {
  Place place;
  std::string message;
};

/// Builds the located tree from yaml-cpp's events; its own node graph has no guard against aliases.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(const std::string& file, Report& report)
      : file_(std::make_shared<const std::string>(file)), report_(report) {}

  Node take() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents_ > 1) throw Stop{spot(mark).place(), "a second document ('---'): a scene file holds one"};
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    Node node;
    node.spot = spot(mark);
    finish(std::move(node), anchor);
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    Node node;
    node.kind = Node::Kind::scalar;
    node.spot = spot(mark);
    node.quoted = tag == "!";
    refuse_tag(tag, node.spot);
    if (value.size() > LoadLimits::scalar_bytes)
      throw Stop{node.place(), "a text of " + std::to_string(value.size()) + " bytes; the longest allowed is 1 MiB"};
    node.text = value;
    if (!node.quoted) std::replace(node.text.begin(), node.text.end(), '\n', ' ');
    finish(std::move(node), anchor);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const Spot here = spot(mark);
    for (const Open& open : open_)
      if (open.anchor == anchor) throw Stop{here.place(), "an alias to a value that it is itself part of"};
    const auto found = anchored_.find(anchor);
    if (found == anchored_.end()) throw Stop{here.place(), "an alias to an unknown anchor"};
    if (expects_key()) throw Stop{here.place(), "an alias cannot be a key"};
    spend_copy(found->second.size, here);
    if (open_.size() + found->second.depth > LoadLimits::depth) throw Stop{here.place(), too_deep()};
    Node copy = found->second;
    copy.spot = here;
    attach(std::move(copy));
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    begin(Node::Kind::list, mark, tag, anchor);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    begin(Node::Kind::map, mark, tag, anchor);
  }
  void OnSequenceEnd() override { end(); }
  void OnMapEnd() override { end(); }

 private:
  struct Open {
    Node node;
    YAML::anchor_t anchor = 0;
    bool has_key = false, skip = false;
    Key key;
    std::unordered_map<std::string, int> lines;
  };

  static std::string too_deep() { return "nested deeper than " + std::to_string(LoadLimits::depth) + " levels"; }

  Spot spot(const YAML::Mark& mark) const { return {file_, mark.line + 1, mark.column + 1}; }

  void refuse_tag(const std::string& tag, const Spot& here) {
    if (!tag.empty() && tag != "?" && tag != "!")
      report_.error(here.place(), "the tag '" + tag.substr(0, 60) + "' is not read: write the bare value");
  }

  bool expects_key() const { return !open_.empty() && open_.back().node.is_map() && !open_.back().has_key; }

  void begin(Node::Kind kind, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    const Spot here = spot(mark);
    if (open_.size() >= LoadLimits::depth) throw Stop{here.place(), too_deep()};
    if (expects_key()) throw Stop{here.place(), "a key must be a single word or text"};
    refuse_tag(tag, here);
    Open open;
    open.node.kind = kind;
    open.node.spot = here;
    open.anchor = anchor;
    open_.push_back(std::move(open));
  }

  void end() {
    Open open = std::move(open_.back());
    open_.pop_back();
    finish(std::move(open.node), open.anchor);
  }

  void finish(Node node, YAML::anchor_t anchor) {
    if (++nodes_ > LoadLimits::nodes)
      throw Stop{node.place(), "more than " + std::to_string(LoadLimits::nodes) + " values in one file"};
    if (anchor != 0 && !expects_key()) {
      spend_copy(node.size, node.spot);
      anchored_[anchor] = node;
    }
    attach(std::move(node));
  }

  void spend_copy(size_t size, const Spot& here) {
    copied_ += size;
    if (copied_ > LoadLimits::expanded)
      throw Stop{here.place(), "aliases that expand to more than " + std::to_string(LoadLimits::expanded) + " values"};
  }

  void attach(Node node) {
    if (open_.empty()) {
      root_ = std::move(node);
      return;
    }
    Open& parent = open_.back();
    if (expects_key()) {
      take_key(parent, node);
      return;
    }
    parent.node.size += node.size;
    parent.node.depth = std::max(parent.node.depth, node.depth + 1);
    if (parent.node.is_list()) {
      parent.node.items.push_back(std::move(node));
    } else {
      parent.has_key = false;
      if (!parent.skip) parent.node.put(std::move(parent.key), std::move(node));
    }
  }

  void take_key(Open& parent, const Node& node) {
    if (!node.is_scalar()) throw Stop{node.place(), "a key must be a single word or text"};
    parent.has_key = true;
    parent.key = {node.text, node.spot};
    const auto [known, fresh] = parent.lines.emplace(node.text, node.spot.line);
    parent.skip = !fresh;
    if (!fresh)
      report_.error(node.place(), "duplicate key '" + node.text.substr(0, 60) + "'; it is already given in line " +
                                      std::to_string(known->second) + ": keep one of them");
  }

  std::shared_ptr<const std::string> file_;
  Report& report_;
  std::vector<Open> open_;
  std::unordered_map<YAML::anchor_t, Node> anchored_;
  Node root_;
  size_t nodes_ = 0, copied_ = 0, documents_ = 0;
};

/// Line and column of a byte that YAML text may not hold, or nothing.
std::optional<Place> bad_byte(const std::string& text, const std::string& file) {
  Place at{file, 1, 1};
  for (size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    size_t length = lead < 0x80 ? 1 : lead < 0xc2 ? 0 : lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : lead < 0xf5 ? 4 : 0;
    if (lead < 0x20 && lead != '\n' && lead != '\r' && lead != '\t') length = 0;
    if (length == 0 || i + length > text.size()) return at;
    for (size_t k = 1; k < length; ++k)
      if ((static_cast<unsigned char>(text[i + k]) & 0xc0u) != 0x80u) return at;
    at.column += static_cast<int>(length);
    if (lead == '\n') at = {file, at.line + 1, 1};
    i += length;
  }
  return std::nullopt;
}

/// Does the line (counted from 0) begin with a tab? yaml-cpp has no words for it.
bool indented_by_tab(const std::string& text, int line) {
  size_t at = 0;
  for (int i = 0; i < line && at != std::string::npos; ++i) {
    at = text.find('\n', at);
    if (at != std::string::npos) ++at;
  }
  if (at == std::string::npos) return false;
  const size_t first = text.find_first_not_of(" \t", at);
  return text.substr(at, first - at).find('\t') != std::string::npos;
}

}  // namespace

std::optional<Node> load_yaml(const std::string& text, const std::string& file, Report& report) {
  const Place start{file, 0, 0};
  if (text.size() > LoadLimits::file_bytes) {
    report.error(start, "the file has " + std::to_string(text.size()) + " bytes; a scene may have 64 MiB");
    return std::nullopt;
  }
  if (const auto place = bad_byte(text, file)) {
    report.error(*place, "a byte that no text holds: save the file as UTF-8 without control characters");
    return std::nullopt;
  }
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    TreeBuilder builder(file, report);
    while (parser.HandleNextDocument(builder)) {
    }
    return builder.take();
  } catch (const Stop& stop) {
    report.error(stop.place, stop.message);
  } catch (const YAML::Exception& error) {
    const bool tab = indented_by_tab(text, error.mark.line);
    report.error({file, error.mark.line + 1, error.mark.column + 1},
                 "not valid YAML: " + (tab ? std::string("a tab in the indentation; YAML wants spaces") : error.msg));
  }
  return std::nullopt;
}

std::optional<std::string> read_text(const std::string& file, const Place& asked, Report& report) {
  const auto refuse = [&](const std::string& why) {
    report.error(asked, "cannot read '" + file + "': " + why);
    return std::nullopt;
  };
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return refuse(std::generic_category().message(errno));
  std::string text;
  char block[1 << 16];
  while (stream.read(block, sizeof block) || stream.gcount() > 0) {
    text.append(block, static_cast<size_t>(stream.gcount()));
    if (text.size() > LoadLimits::file_bytes) return refuse("it is larger than 64 MiB");
  }
  if (stream.bad()) return refuse("it is not a readable file");
  return text;
}

}  // namespace scree::core
