#include "validation/effects/effect_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "msa/base/units.h"
#include "msa/fields/field_reader.h"
#include "msa/fields/file_kind.h"
#include "msa/fields/yaml_tree.h"
#include "msa/mechanism/fields.h"
#include "msa/mechanism/joint_table.h"
#include "validation/effects/effect_value.h"
#include "validation/effects/parameter_unit.h"

namespace deflect::effects {
namespace {

constexpr const char* action_keys[] = {"set", "append", "multiply", "add"};

bool in_name(unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; }

void describe(FieldVisitor& v, EffectParameter& p) {
  const Quantity number{Dimension::none, {}, std::nullopt};
  const auto unit = unit_of_parameter(p.name);
  v.require(unit.has_value(), "",
            fmt::format("ends like a unit that is not known: end the name with one of {}, or with none for a plain "
                        "number",
                        known_parameter_units()));
  p.unit = unit.value_or("");
  v.quantity("start", p.start, number, "where a search begins");
  v.quantity("low", p.low, number, "lower bound of a search");
  v.quantity("high", p.high, number, "upper bound of a search");
  std::string scale = p.log ? "log" : "linear";
  v.word("scale", scale, {"scale", {"linear", "log"}, "linear"}, "how it is searched");
  p.log = scale == "log";
  std::string vanishes;
  v.text("vanishes", vanishes, Need::optional, "value at which the effect is absent, or infinity");
  p.vanishes.reset();
  if (vanishes == "infinity") {
    p.vanishes = std::numeric_limits<double>::infinity();
  } else if (!vanishes.empty()) {
    const auto parsed = outcome_of<InputError>([&] { return parse_number(vanishes); });
    v.require(bool(parsed), "vanishes", fmt::format("{}: a number or 'infinity' is wanted", parsed.why));
    p.vanishes = parsed.value;
  }
  v.text("about", p.about, Need::required, "what it is, with its unit");
  std::string given = p.optional ? "optional" : "required";
  v.word("value", given, {"need of a value", {"required", "optional"}, "required"},
         "whether a value must be given where the effect is added; optional: its start is taken");
  p.optional = given == "optional";
  v.require(p.low < p.high, "high", fmt::format("{} must be above low, {}", p.high, p.low));
  v.require(p.low <= p.start && p.start <= p.high, "start",
            fmt::format("{} must lie between low, {}, and high, {}", p.start, p.low, p.high));
  v.require(
      !p.vanishes || *p.vanishes != p.start, "start",
      fmt::format("{} is where the effect is absent, so that nothing would be seen of it: start beside it", p.start));
  v.require(!p.log || p.low > 0, "low", fmt::format("{} must be above 0 on a logarithmic scale", p.low));
}

class Parameters final : public Elements {
 public:
  explicit Parameters(std::vector<EffectParameter>& all) : all_(all) {}
  std::size_t size() const override { return all_.size(); }
  std::string name(std::size_t i) const override { return all_[i].name; }
  void add(const std::string& name) override { all_.emplace_back().name = name; }
  void describe_element(FieldVisitor& v, std::size_t i) override { describe(v, all_[i]); }

 private:
  std::vector<EffectParameter>& all_;
};

class Edits final : public Elements {
 public:
  explicit Edits(Effect& effect) : effect_(effect) {}
  std::size_t size() const override { return effect_.edits.size(); }
  std::string name(std::size_t) const override { return ""; }
  void add(const std::string&) override { effect_.edits.emplace_back(); }
  void describe_element(FieldVisitor& v, std::size_t i) override {
    EffectEdit& edit = effect_.edits[i];
    v.keys({"at", action_keys[0], action_keys[1], action_keys[2], action_keys[3]});
    v.texts("at", edit.paths, Need::required, "path of the field, or a list of alternatives");
    const std::size_t action =
        v.alternative({std::begin(action_keys), std::end(action_keys)}, static_cast<std::size_t>(edit.action));
    edit.action = static_cast<EffectEdit::Action>(action);
    v.any(action_keys[action], edit.value, "0.5", "what stands there then");
    if (effect_.scope != Scope::one_leg) return;
    for (const std::string& path : edit.paths)
      v.require(path.starts_with("leg."), "at",
                fmt::format("'{}' is not in a leg: an effect of one leg edits what begins with 'leg.'", path));
  }

 private:
  Effect& effect_;
};

void describe(FieldVisitor& v, Effect& e) {
  v.keys({"name", "title", "scope", "parameters", "edits", "pages", "see"});
  v.text("name", e.name, Need::required, "id of the effect");
  v.require(std::all_of(e.name.begin(), e.name.end(), in_name), "name",
            "consists of letters, digits, '_' and '-': it is written on command lines");
  v.text("title", e.title, Need::required, "the effect in one line");
  std::string scope = nth(scope_names, e.scope);
  const std::vector<std::string> scopes{std::begin(scope_names), std::end(scope_names)};
  v.word("scope", scope, {"scope", scopes, std::nullopt}, "what the effect sits in");
  e.scope = static_cast<Scope>(std::find(scopes.begin(), scopes.end(), scope) - scopes.begin());
  Parameters parameters(e.parameters);
  v.entries("parameters", parameters, Need::optional, "physical parameters by name");
  Edits edits(e);
  v.list("edits", edits, "what changes in the description");
  v.require(!e.edits.empty(), "edits", "needs at least one edit '- {at: PATH, set: VALUE}'");
  const auto pages = [&] {
    v.text("machine", e.pages.machine, Need::required, "what happens in the machine");
    v.text("data", e.pages.data, Need::required, "what it looks like in the data");
    v.text("bench", e.pages.bench, Need::required, "how to confirm it on the bench");
    v.text("cure", e.pages.cure, Need::required, "what to do about it");
  };
  v.object("pages", Need::required, false, pages, "the effect explained");
  v.text("see", e.see, Need::optional, "sources");
}

/// What the field list cannot see: parameters in values, and laws, which are tried with the parameters' start.
class ValueCheck {
 public:
  ValueCheck(const Effect& effect, VectorX start) : effect_(effect), start_(std::move(start)) {}

  void check(const YamlNode& edits) {
    std::vector<bool> used(effect_.parameters.size());
    for (std::size_t i = 0; i < effect_.edits.size(); ++i) {
      const char* key = nth(action_keys, effect_.edits[i].action);
      const YamlNode& value = *edits.children[i].child(key);
      const std::string path = fmt::format("edits.{}.{}", i, key);
      check_names(value, path);
      check_laws(value, path, effect_.edits[i].paths);
      const std::vector<bool> here = parameters_used(value, effect_);
      for (std::size_t k = 0; k < used.size(); ++k) used[k] = used[k] || here[k];
    }
    for (std::size_t k = 0; k < used.size(); ++k)
      if (!used[k])
        fail(edits.key_line, "edits",
             fmt::format("none uses the parameter: write '${}' in a value or remove it", effect_.parameters[k].name));
  }

 private:
  [[noreturn]] void fail(int line, const std::string& path, const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}: {}", effect_.origin, line, path, what));
  }

  void check_names(const YamlNode& node, const std::string& path) const {
    for (std::size_t i = 0; i < node.children.size(); ++i)
      check_names(node.children[i], joined(path, node.keys.empty() ? std::to_string(i) : node.keys[i]));
    if (node.kind != YamlNode::Kind::scalar || node.text.find('$') == std::string::npos) return;
    if (node.text.find('$', 1) != std::string::npos || !node.text.starts_with('$'))
      fail(node.line, path,
           fmt::format("'{}': a parameter stands alone or before a unit, as in '$name N/mm'", node.text));
    const ParameterUse use = parameter_use(node.text);
    std::vector<std::string> names;
    for (const EffectParameter& p : effect_.parameters) names.push_back("$" + p.name);
    if (std::find(names.begin(), names.end(), "$" + use.name) == names.end())
      fail(node.line, path, fmt::format("unknown parameter '${}'{}", use.name, suggestion("$" + use.name, names)));
  }

  /// A law needs no device to be read, except for names of materials, which are taken as they come.
  void check_laws(const YamlNode& value, const std::string& path, const std::vector<std::string>& paths) const {
    if (value.kind == YamlNode::Kind::list)
      for (std::size_t i = 0; i < value.children.size(); ++i)
        check_laws(value.children[i], joined(path, std::to_string(i)), paths);
    if (value.kind != YamlNode::Kind::map || !value.child("law")) return;
    const YamlNode node = filled_in(value, effect_, start_);
    Named<Material> materials;
    if (const YamlNode* material = node.child("material")) materials.emplace_back(material->text, Material{});
    std::string first_error;
    for (const bool rotation : motions_of(paths)) {
      const auto read = outcome_of<InputError>([&] {
        FieldReader reader(effect_.origin, path);
        reader.surroundings.materials = &materials;
        reader.surroundings.rotation = rotation;
        reader.surroundings.side_by_side = beside(paths);
        Law law;
        reader.read(node, [&] { describe(reader, law); });
        return true;
      });
      if (read) return;
      if (first_error.empty()) first_error = read.why;
    }
    throw InputError(first_error);
  }

  static bool beside(const std::vector<std::string>& paths) {
    return std::any_of(paths.begin(), paths.end(),
                       [](const std::string& path) { return path.find(".beside.") != path.npos; });
  }

  /// Whether the laws at these paths act on rotations: no, yes or, where only the device knows, both.
  static std::vector<bool> motions_of(const std::vector<std::string>& paths) {
    const auto on = [&](char kind) {
      return std::any_of(paths.begin(), paths.end(), [&](const std::string& path) {
        const std::string end = path.substr(path.rfind('.') + 1);
        if (end == "<slide>" || end == "<turn>") return end[1] == (kind == 't' ? 's' : 't');
        const bool freedom = std::find(freedom_names.begin(), freedom_names.end(), end) != freedom_names.end();
        return !freedom || end[0] == kind;
      });
    };
    std::vector<bool> out;
    if (on('t')) out.push_back(false);
    if (on('r')) out.push_back(true);
    return out;
  }

  const Effect& effect_;
  VectorX start_;
};

void trim(std::string& text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
}

/// A text as YAML, in quotation marks where it needs them.
std::string written(const std::string& text) {
  YamlNode node;
  node.kind = YamlNode::Kind::scalar;
  node.text = text;
  node.quoted = true;
  return flow_yaml(node);
}

}  // namespace

Effect parse_effect(std::string_view yaml, const std::string& origin) {
  const YamlNode tree = parse_yaml(yaml, origin);
  require_kind(tree, FileKind::effect, origin);
  Effect e;
  e.origin = origin;
  FieldReader reader(origin);
  reader.read(tree, [&] { describe(reader, e); });
  for (const std::string& path : reader.ours())
    throw InputError(fmt::format("{}: {}: an effect has no !ours", origin, path));
  e.line = tree.child("name")->line;
  const YamlNode& edits = *tree.child("edits");
  VectorX start(std::ssize(e.parameters));
  for (std::size_t i = 0; i < e.parameters.size(); ++i) start(as_index(i)) = e.parameters[i].start;
  ValueCheck(e, start).check(edits);
  for (std::size_t i = 0; i < e.edits.size(); ++i) e.edits[i].line = edits.children[i].line;
  for (std::string* text : {&e.title, &e.pages.machine, &e.pages.data, &e.pages.bench, &e.pages.cure, &e.see})
    trim(*text);
  return e;
}

Effect read_effect(const std::filesystem::path& path) { return parse_effect(read_text(path), path.string()); }

std::string write_effect(const Effect& e) {
  std::string name = e.name;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return !in_name(c); }, '_');
  std::string out =
      fmt::format("name: {}\ntitle: {}\nscope: {}\n", written(name), written(e.title), nth(scope_names, e.scope));
  if (!e.parameters.empty()) out += "parameters:\n";
  for (const EffectParameter& p : e.parameters) {
    out += fmt::format("  {}: {{start: {:.17g}, low: {:.17g}, high: {:.17g}, scale: {}", p.name, p.start, p.low, p.high,
                       p.log ? "log" : "linear");
    if (p.vanishes)
      out += std::isinf(*p.vanishes) ? ", vanishes: infinity" : fmt::format(", vanishes: {}", *p.vanishes);
    out += fmt::format(", about: {}{}}}\n", written(p.about), p.optional ? ", value: optional" : "");
  }
  out += "edits:\n";
  for (const EffectEdit& edit : e.edits) {
    std::vector<std::string> paths;
    for (const std::string& path : edit.paths) paths.push_back(written(path));
    out += fmt::format("  - {{at: [{}], {}: {}}}\n", fmt::join(paths, ", "), nth(action_keys, edit.action), edit.value);
  }
  out += "pages:\n";
  for (const auto& [key, text] : {std::pair{"machine", &e.pages.machine},
                                  {"data", &e.pages.data},
                                  {"bench", &e.pages.bench},
                                  {"cure", &e.pages.cure}})
    out += fmt::format("  {}: {}\n", key, written(*text));
  if (!e.see.empty()) out += fmt::format("see: {}\n", written(e.see));
  return out;
}

std::vector<Effect> catalogue(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  if (error)
    throw InputError(fmt::format("{}: the folder of effects cannot be read: {}", folder.string(), error.message()));
  std::sort(files.begin(), files.end());
  std::vector<Effect> all;
  for (const std::filesystem::path& file : files) add_effect(all, read_effect(file));
  return all;
}

void add_effect(std::vector<Effect>& all, Effect e) {
  for (const Effect& other : all)
    if (other.name == e.name)
      throw InputError(fmt::format("{}:{}: name: there is an effect '{}' already ({}:{}): give this one another name",
                                   e.origin, e.line, e.name, other.origin, other.line));
  all.push_back(std::move(e));
}

const Effect& find_effect(const std::vector<Effect>& all, const std::string& name) {
  std::vector<std::string> names;
  for (const Effect& e : all) {
    if (e.name == name) return e;
    names.push_back(e.name);
  }
  throw InputError(fmt::format("there is no effect '{}'{}; if it is one of your own, name its file with --effects FILE",
                               name, suggestion(name, names)));
}

}  // namespace deflect::effects
