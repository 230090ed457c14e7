#include "msa/fields/plain_yaml.h"
#include "msa/base/index.h"

#include <algorithm>
#include <array>
#include <unordered_set>

namespace deflect {
namespace {

using Kind = YamlNode::Kind;

constexpr int deepest = 20;
constexpr std::size_t longest_key = 200;  // a key ends on its line and within 1024 characters

bool is_alnum(char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// What may stand inside a plain value of any context.
bool is_plain(char c) {
  static const std::array<bool, 256> plain = [] {
    std::array<bool, 256> table{};
    for (int i = 0; i < 128; ++i) nth(table, i) = is_alnum(static_cast<char>(i));
    for (const char other : std::string_view(" _.+-*/^%()=<>")) table[static_cast<unsigned char>(other)] = true;
    return table;
  }();
  return plain[static_cast<unsigned char>(c)];
}

/// What YAML reads as no value at all.
bool is_null(std::string_view s) { return s == "null" || s == "Null" || s == "NULL"; }

class Scanner {
 public:
  explicit Scanner(std::string_view text) : rest_(text) { next_line(); }

  std::optional<YamlNode> document() {
    if (end_ || indent_ != 0) return {};
    YamlNode root;
    if (!block_map(root, 0, 0) || !end_) return {};
    return root;
  }

 private:
  /// To the next line that says something; line_ is what stands behind its indent.
  void next_line() {
    while (!rest_.empty()) {
      const std::size_t length = std::min(rest_.find('\n'), rest_.size());
      line_ = rest_.substr(0, length);
      rest_.remove_prefix(std::min(length + 1, rest_.size()));
      ++number_;
      const std::size_t from = std::min(line_.find_first_not_of(' '), line_.size());
      indent_ = static_cast<int>(from);
      line_.remove_prefix(from);
      if (!line_.empty() && line_.front() != '#') return;
    }
    end_ = true;
  }

  /// The plain text at the start of line_, without spaces behind it; empty where there is none.
  std::string_view plain() {
    const auto stop = std::find_if_not(line_.begin(), line_.end(), is_plain);
    std::string_view text = line_.substr(0, as_size(stop - line_.begin()));
    line_.remove_prefix(text.size());
    text = text.substr(0, text.find_last_not_of(' ') + 1);
    const bool number = text.size() > 1 && (text[0] == '-' || text[0] == '+' || text[0] == '.') && is_alnum(text[1]);
    return !text.empty() && (is_alnum(text[0]) || number) && !is_null(text) ? text : std::string_view();
  }

  /// "key:" with a space or the end of the line behind it.
  std::string_view key() {
    const std::string_view text = plain();
    if (text.empty() || text.size() > longest_key || !line_.starts_with(':')) return {};
    line_.remove_prefix(1);
    return line_.empty() || line_.front() == ' ' ? text : std::string_view();
  }

  void skip_spaces() { line_.remove_prefix(std::min(line_.find_first_not_of(' '), line_.size())); }

  bool take(char c) {
    skip_spaces();
    if (!line_.starts_with(c)) return false;
    line_.remove_prefix(1);
    return true;
  }

  /// A plain value or a flow collection; what follows it on the line is left.
  bool value(YamlNode& out, int depth) {
    skip_spaces();
    out.line = number_;
    if (take('{')) return flow_map(out, depth + 1);
    if (take('[')) return flow_list(out, depth + 1);
    const std::string_view text = plain();
    out.kind = Kind::scalar;
    out.text = text;
    return !text.empty();
  }

  bool flow_list(YamlNode& out, int depth) {
    out.kind = Kind::list;
    if (depth > deepest) return false;
    if (take(']')) return true;
    out.children.reserve(3);
    do {
      if (!value(out.children.emplace_back(), depth)) return false;
    } while (take(','));
    return take(']');
  }

  bool flow_map(YamlNode& out, int depth) {
    out.kind = Kind::map;
    if (depth > deepest) return false;
    if (take('}')) return true;
    out.keys.reserve(4);
    out.children.reserve(4);
    do {
      skip_spaces();
      const std::string_view name = key();
      if (name.empty() || std::find(out.keys.begin(), out.keys.end(), name) != out.keys.end()) return false;
      out.keys.emplace_back(name);
      if (!value(out.children.emplace_back(), depth)) return false;
      out.children.back().key_line = number_;
    } while (take(','));
    return take('}');
  }

  /// From the line that is there, all lines at this indent, with what stands below them.
  bool block_map(YamlNode& out, int indent, int depth) {
    out.kind = Kind::map;
    out.line = number_;
    if (depth > deepest) return false;
    std::unordered_set<std::string_view> known;
    while (!end_ && indent_ == indent) {
      const std::string_view name = key();
      if (name.empty() || !known.insert(name).second) return false;
      const int key_line = number_;
      YamlNode& child = out.children.emplace_back();
      out.keys.emplace_back(name);
      skip_spaces();
      if (line_.empty()) {
        next_line();
        if (end_ || indent_ <= indent || !block_map(child, indent_, depth + 1)) return false;
      } else {
        if (!value(child, depth)) return false;
        skip_spaces();
        if (!line_.empty()) return false;
        next_line();
      }
      child.key_line = key_line;
      if (!end_ && indent_ > indent) return false;  // a value that goes on, or a wrong indent
    }
    return true;
  }

  std::string_view rest_, line_;
  int number_ = 0, indent_ = 0;
  bool end_ = false;
};

}  // namespace

std::optional<YamlNode> parse_plain_yaml(std::string_view text) { return Scanner(text).document(); }

}  // namespace deflect
