// yaml-cpp's events into a tree. Events rather than its nodes: only they show doubled keys, tags and aliases as they
// stand in the file.
#include <fmt/format.h>
#include <yaml-cpp/depthguard.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <optional>
#include <sstream>
#include <unordered_map>

#include "msa/base/error.h"
#include "msa/fields/plain_yaml.h"
#include "msa/fields/yaml_tree.h"

namespace deflect {
namespace {

using Kind = YamlNode::Kind;

/// Bytes of the UTF-8 sequence that begins here, 0 when there is none.
std::size_t utf8_length(std::string_view s) {
  const auto byte = [&](std::size_t i) { return i < s.size() ? static_cast<unsigned char>(s[i]) : 0u; };
  const std::size_t n = byte(0) < 0x80                      ? 1
                        : byte(0) >= 0xc2 && byte(0) < 0xe0 ? 2
                        : byte(0) >= 0xe0 && byte(0) < 0xf0 ? 3
                        : byte(0) >= 0xf0 && byte(0) < 0xf5 ? 4
                                                            : 0;
  for (std::size_t i = 1; i < n; ++i)
    if ((byte(i) & 0xc0) != 0x80) return 0;
  const unsigned second = byte(1);
  const bool overlong = (byte(0) == 0xe0 && second < 0xa0) || (byte(0) == 0xf0 && second < 0x90);
  const bool surrogate = byte(0) == 0xed && second > 0x9f, beyond = byte(0) == 0xf4 && second > 0x8f;
  return overlong || surrogate || beyond ? 0 : n;
}

/// yaml-cpp gives the escapes \N and \_ as one byte each, which is no UTF-8. No other escape and no character of the
/// file gives a lone byte.
std::string in_utf8(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t n = utf8_length(std::string_view(text).substr(i));
    if (n == 0) out += '\xc2';
    out.append(text, i, std::max<std::size_t>(n, 1));
    i += std::max<std::size_t>(n, 1);
  }
  return out;
}

class Builder : public YAML::EventHandler {
 public:
  explicit Builder(const std::string& origin) : origin_(origin) {}

  int documents = 0;
  YamlNode root;

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents > 1) fail(mark.line + 1, "a second document, or text after the end: a file holds one map");
  }
  void OnDocumentEnd() override {}
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { refuse_anchor(mark.line + 1); }

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    if (wants_key()) fail(mark.line + 1, "a key is missing here");
    value(node(Kind::null, mark, "?", anchor));
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& text) override {
    if (wants_key()) return key(mark.line + 1, tag, anchor, in_utf8(text));
    YamlNode scalar = node(Kind::scalar, mark, tag, anchor);
    scalar.text = in_utf8(text);
    if (text.empty() && scalar.ours) scalar.kind = Kind::null;  // "!ours" with nothing behind it
    value(std::move(scalar));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(node(Kind::list, mark, tag, anchor));
  }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(node(Kind::map, mark, tag, anchor));
  }
  void OnSequenceEnd() override { close(); }
  void OnMapEnd() override { close(); }

 private:
  [[noreturn]] void fail(int line, const std::string& what) const {
    const std::string path = path_to_here();
    throw InputError(fmt::format("{}:{}: {}{}{}", origin_, line, path, path.empty() ? "" : ": ", what));
  }
  [[noreturn]] void refuse_anchor(int line) const {
    fail(line, "anchors and aliases (& *) are not read: write the value out");
  }

  std::string path_to_here() const {
    std::string path;
    for (const Open& o : open_) {
      if (o.node.kind == Kind::list) path = joined(path, std::to_string(o.node.children.size()));
      if (o.node.keys.size() > o.node.children.size()) path = joined(path, o.node.keys.back());
    }
    return path;
  }

  bool wants_key() const {
    return !open_.empty() && open_.back().node.kind == Kind::map &&
           open_.back().node.keys.size() == open_.back().node.children.size();
  }

  YamlNode node(Kind kind, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) const {
    if (anchor) refuse_anchor(mark.line + 1);
    if (!tag.empty() && tag != "?" && tag != "!" && tag != "!ours")
      fail(mark.line + 1, fmt::format("unknown tag '{}': the one tag known is !ours", tag));
    YamlNode out;
    out.kind = kind;
    out.line = mark.line + 1;
    out.ours = tag == "!ours";
    out.quoted = tag == "!";
    return out;
  }

  void key(int line, const std::string& tag, YAML::anchor_t anchor, const std::string& text) {
    if (anchor) refuse_anchor(line);
    if (tag != "?" && tag != "!") fail(line, fmt::format("'{}': a tag stands before the value, not the key", text));
    YamlNode& map = open_.back().node;
    const auto [first, fresh] = open_.back().index.emplace(text, map.keys.size());
    map.keys.push_back(text);
    open_.back().key_line = line;
    if (!fresh)
      fail(line, fmt::format("given twice, first on line {}: remove one", map.children[first->second].key_line));
  }

  void open(YamlNode node) {
    if (wants_key()) fail(node.line, "a key must be a name, not a list or a map");
    open_.push_back({std::move(node), 0, {}});
  }
  void close() {
    YamlNode done = std::move(open_.back().node);
    open_.pop_back();
    value(std::move(done));
  }
  void value(YamlNode done) {
    if (open_.empty()) {
      root = std::move(done);
      return;
    }
    done.key_line = open_.back().key_line;
    open_.back().node.children.push_back(std::move(done));
  }

  struct Open {
    YamlNode node;
    int key_line;
    std::unordered_map<std::string, std::size_t> index;  // of a map's keys
  };
  std::string origin_;
  std::vector<Open> open_;
};

class Ignore : public YAML::EventHandler {
 public:
  /// At a comma or a closing bracket where a value is wanted yaml-cpp finds an empty document, and does so again for
  /// ever.
  void OnDocumentStart(const YAML::Mark& mark) override {
    if (mark.pos == begun_) throw YAML::ParserException(mark, "a value, a key or the end was expected here");
    begun_ = mark.pos;
  }

 private:
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}

  int begun_ = -1;  // where the last document begins
};

/// yaml-cpp takes byte 4 for the end of the file and passes invalid UTF-8 on.
void check_characters(std::string_view text, const std::string& origin) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    throw InputError(fmt::format("{}:1: the file is UTF-16: save it as UTF-8", origin));
  int line = 1;
  for (std::size_t i = 0; i < text.size();) {
    const auto c = static_cast<unsigned char>(text[i]);
    if ((c < 0x20 && c != '\n' && c != '\r' && c != '\t') || c == 0x7f)
      throw InputError(fmt::format("{}:{}: control character 0x{:02x}: the file must be text", origin, line, c));
    const std::size_t n = c < 0x80 ? 1 : utf8_length(text.substr(i));
    if (n == 0)
      throw InputError(fmt::format("{}:{}: byte 0x{:02x} is not UTF-8: save the file as UTF-8", origin, line, c));
    if (c == '\n') ++line;
    i += n;
  }
}

void parse(const std::string& text, YAML::EventHandler& handler) {
  std::istringstream in(text);
  YAML::Parser parser(in);
  while (parser.HandleNextDocument(handler)) {
  }
}

/// The line, counted from 1, that is indented with a tab: that of an error or the one before it.
std::optional<int> tab_indented_line(const std::string& text, int error_line) {
  std::optional<int> found;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; number <= error_line && std::getline(lines, line); ++number) {
    const std::string indent = line.substr(0, line.find_first_not_of(" \t"));
    if (!found && number >= error_line - 1 && indent.find('\t') != indent.npos) found = number;
  }
  return found;
}

/// Before anything is made of the events: those that precede a syntax error can be nonsense.
void check_syntax(const std::string& text, const std::string& end, const std::string& origin) {
  Ignore ignore;
  try {
    parse(text + end, ignore);
  } catch (const YAML::DeepRecursion& e) {
    throw InputError(fmt::format("{}:{}: is nested too deeply: hundreds of brackets or indents, one inside the other",
                                 origin, e.mark.line + 1));
  } catch (const YAML::Exception& e) {
    const bool open = e.msg == YAML::ErrorMsg::DOC_IN_SCALAR || e.msg == YAML::ErrorMsg::EOF_IN_SCALAR;
    const auto lines = static_cast<int>(std::count(text.begin(), text.end(), '\n')) + !text.ends_with('\n');
    const int line = std::clamp(e.mark.line + 1, 1, std::max(lines, 1));
    if (const std::optional<int> tab = tab_indented_line(text, line))
      throw InputError(
          fmt::format("{}:{}: not valid YAML: the line is indented with a tab; YAML wants spaces: write two "
                      "in place of each tab",
                      origin, *tab));
    throw InputError(
        fmt::format("{}:{}: not valid YAML: {}", origin, line, open ? "a quotation is not closed" : e.msg));
  }
}

}  // namespace

YamlNode parse_yaml(std::string_view text, const std::string& origin) {
  check_characters(text, origin);
  if (std::optional<YamlNode> plain = parse_plain_yaml(text)) return std::move(*plain);
  return parse_any_yaml(text, origin);
}

YamlNode parse_any_yaml(std::string_view text, const std::string& origin) {
  check_syntax(std::string(text), "", origin);
  // yaml-cpp closes a quotation by itself at the end of the text, but not at the end of a document.
  check_syntax(std::string(text), "\n...\n", origin);
  Builder builder(origin);
  parse(std::string(text), builder);
  builder.root.line = std::max(builder.root.line, 1);
  return std::move(builder.root);
}

}  // namespace deflect
