#include "validation/report/schema_results.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "msa/mechanism/device_schema.h"
#include "validation/json/json_text.h"

namespace deflect::report {
namespace {

std::string joined_units(Dimension d) {
  const std::vector<std::string> units = units_of(d);
  if (units.empty()) return "number";
  return d == Dimension::ratio ? "number or %" : fmt::format("{}", fmt::join(units, ", "));
}

std::string alone(const SchemaField& f) {
  return f.alone.empty() ? "" : fmt::format(", or the value of its {} alone", f.alone);
}

/// What stands behind the key, in a few words.
std::string type_of(const SchemaField& f) {
  const auto word = [&] {
    return f.words.empty() ? "name of " + std::string(f.what.find_first_of("aeiou") == 0 ? "an " : "a ") + f.what
                           : fmt::format("{}", fmt::join(f.words, ", "));
  };
  switch (f.kind) {
    case FieldKind::quantity:
      return joined_units(f.dimension) + (f.or_dimension ? ", " + joined_units(*f.or_dimension) : "") +
             (f.words.empty() ? "" : fmt::format(", {}", fmt::join(f.words, ", ")));
    case FieldKind::integer:
      return "whole number";
    case FieldKind::vector3:
      return f.dimension == Dimension::none ? "[x, y, z] direction" : "[x, y, z] " + joined_units(f.dimension);
    case FieldKind::matrix:
      return f.size ? fmt::format("{0} rows of {0} numbers", f.size) : "rows of numbers, as many";
    case FieldKind::pairs:
      return fmt::format("list of [{}; {}]", joined_units(f.dimension), joined_units(*f.second));
    case FieldKind::text:
      return "text";
    case FieldKind::texts:
      return "a word or a list of words";
    case FieldKind::word:
      return word();
    case FieldKind::any:
      return "any value";
    case FieldKind::object:
      return f.or_word ? word() + ", or a map" : "map";
    case FieldKind::entries:
      return (f.plain ? "values by name" : "maps by name") + alone(f);
    case FieldKind::list:
      return "list of maps";
    case FieldKind::one_or_list:
      return "map or list of maps" + alone(f);
    case FieldKind::others:
      return "values by path";
  }
  return "";
}

const SchemaField* find_field(const SchemaCase& c, const std::string& key) {
  const auto found = std::find_if(c.fields.begin(), c.fields.end(), [&](const auto& f) { return f.key == key; });
  return found == c.fields.end() ? nullptr : &*found;
}

/// Whether the field is the same in every case; a word that decides is, whatever follows from it.
bool common(const SchemaLevel& level, const SchemaField& f) {
  return std::all_of(level.cases.begin(), level.cases.end(), [&](const SchemaCase& c) {
    const SchemaField* other = find_field(c, f.key);
    return other && other->kind == f.kind && other->dimension == f.dimension && other->required == f.required &&
           other->level == f.level;
  });
}

std::string row_of(const SchemaField& f, const Schema& schema) {
  std::string must = f.required ? "required" : f.otherwise.empty() ? "" : "default " + f.otherwise;
  std::string row = fmt::format("    {:<22} {}{}\n", f.key.empty() ? "(the value itself)" : f.key, type_of(f),
                                must.empty() ? "" : "; " + must);
  row += fmt::format("    {:<22} {}", "", f.about);
  if (f.level != SchemaField::no_level && !f.or_word) {
    const std::string& path = schema.levels[f.level].path;
    row += fmt::format(": see {}", path);
  }
  return row + "\n";
}

std::string choices_of(const SchemaCase& c) {
  std::string text;
  for (const auto& [key, words] : c.choices) {
    const bool there = key.find('|') != key.npos;
    text += fmt::format("{}{}{}", text.empty() ? "" : ", ", there ? "" : key + ": ", fmt::join(words, " or "));
  }
  return text;
}

std::string level_table(const SchemaLevel& level, const Schema& schema) {
  std::string text = level.path.empty() ? "\n  the file\n" : fmt::format("\n  {}\n", level.path);
  for (const SchemaField& f : level.cases.front().fields)
    if (common(level, f)) text += row_of(f, schema);
  for (const SchemaCase& c : level.cases) {
    std::string rows;
    for (const SchemaField& f : c.fields)
      if (!common(level, f)) rows += row_of(f, schema);
    if (!rows.empty()) text += fmt::format("   with {}\n{}", choices_of(c), rows);
  }
  return text;
}

// JSON Schema

Json number_json(const SchemaField& f) {
  std::vector<std::string> units = units_of(f.dimension);
  if (f.or_dimension)
    for (std::string& unit : units_of(*f.or_dimension)) units.push_back(std::move(unit));
  const std::string number = "[-+]?([0-9]+\\.?[0-9]*|\\.[0-9]+)([eE][-+]?[0-9]+)?";
  Json plain = {{"type", "number"}};
  if (f.range.low > -std::numeric_limits<double>::infinity())
    plain[f.range.open ? "exclusiveMinimum" : "minimum"] = f.range.low;
  if (f.range.high < std::numeric_limits<double>::infinity())
    plain[f.range.open ? "exclusiveMaximum" : "maximum"] = f.range.high;
  if (units.empty()) return plain;
  std::string alternatives;
  for (const std::string& unit : units) {
    alternatives += alternatives.empty() ? "" : "|";
    for (const char c : unit)
      alternatives += c == 'u' ? "(u|\u00B5|\u03BC)"  // micro: both signs are read
                      : std::string_view("^*()/%").find(c) == std::string_view::npos ? std::string(1, c)
                                                                                     : fmt::format("\\{}", c);
  }
  const Json text = {{"type", "string"}, {"pattern", fmt::format("^{} *({})$", number, alternatives)}};
  return f.dimension == Dimension::ratio ? Json{{"anyOf", {plain, text}}} : text;
}

Json quantity_json(const SchemaField& f) {
  return f.words.empty() ? number_json(f) : Json{{"anyOf", {number_json(f), Json{{"enum", f.words}}}}};
}

Json array_of(const Json& items, std::size_t count) {
  Json out = {{"type", "array"}, {"items", items}};
  if (count) out["minItems"] = out["maxItems"] = count;
  return out;
}

Json pair_json(const SchemaField& f) {
  SchemaField second = f;
  second.dimension = *f.second;
  return {{"type", "array"}, {"prefixItems", {number_json(f), number_json(second)}}, {"minItems", 2}, {"maxItems", 2}};
}

Json word_json(const SchemaField& f) {
  // YAML reads some names as numbers or truth values.
  return f.words.empty() ? Json{{"type", {"string", "number", "boolean"}}} : Json{{"enum", f.words}};
}

class JsonSchema {
 public:
  JsonSchema(const NamedSchema& named, Json& definitions) : schema_(named.schema), prefix_(named.name) {
    for (std::size_t i = 0; i < schema_.levels.size(); ++i) definitions[name_of(i)] = level_json(schema_.levels[i]);
  }

  Json reference(std::size_t level) const { return {{"$ref", "#/$defs/" + name_of(level)}}; }

 private:
  std::string name_of(std::size_t level) const {
    std::string name =
        prefix_ + (level == 0 ? "" : "." + schema_.levels[level].path) + (level == 0 ? "" : fmt::format(".{}", level));
    std::replace(name.begin(), name.end(), ' ', '-');
    return name;
  }

  Json field_json(const SchemaField& f) const {
    Json out = bare_json(f);
    out["description"] = f.about;
    if (!f.otherwise.empty()) out["default"] = f.otherwise;
    return out;
  }

  Json bare_json(const SchemaField& f) const {
    switch (f.kind) {
      case FieldKind::quantity:
        return quantity_json(f);
      case FieldKind::integer:
        return {{"type", "integer"}, {"minimum", f.range.low}};
      case FieldKind::vector3:
        return array_of(quantity_json(f), 3);
      case FieldKind::matrix:
        return array_of(array_of({{"type", "number"}}, f.size), f.size);
      case FieldKind::pairs:
        return array_of(pair_json(f), 0);
      case FieldKind::text:
      case FieldKind::others:
        return {{"type", {"string", "number", "boolean"}}};
      case FieldKind::texts:
        return {{"anyOf", {Json{{"type", "string"}}, array_of({{"type", "string"}}, 0)}}};
      case FieldKind::word:
        return word_json(f);
      case FieldKind::any:
        return Json::object();
      case FieldKind::object:
        return f.or_word ? Json{{"anyOf", {word_json(f), reference(f.level)}}} : reference(f.level);
      case FieldKind::entries: {
        const Json each =
            f.plain ? bare_json(schema_.levels[f.level].cases.front().fields.front()) : or_alone(f, reference(f.level));
        return {{"type", "object"}, {"additionalProperties", each}};
      }
      case FieldKind::list:
        return array_of(reference(f.level), 0);
      case FieldKind::one_or_list:
        return or_alone(f, {{"anyOf", {reference(f.level), array_of(reference(f.level), 0)}}});
    }
    return {};
  }

  Json or_alone(const SchemaField& f, const Json& map) const {
    for (const SchemaCase& c : schema_.levels[f.level].cases)
      if (const SchemaField* field = f.alone.empty() ? nullptr : find_field(c, f.alone))
        return {{"anyOf", {map, bare_json(*field)}}};
    return map;
  }

  Json case_json(const SchemaCase& c) const {
    Json properties = Json::object(), required = Json::array(), paths;
    for (const SchemaField& f : c.fields) {
      if (f.kind == FieldKind::others) {
        paths[R"(\.)"] = field_json(f);
        continue;
      }
      properties[f.key] = field_json(f);
      if (f.required) required.push_back(f.key);
    }
    for (const auto& [key, words] : c.choices) {
      if (key.find('|') != key.npos) {
        if (words.size() == 1 && properties.contains(words.front()) &&
            std::find(required.begin(), required.end(), words.front()) == required.end())
          required.push_back(words.front());
      } else {
        properties[key]["enum"] = words;
      }
    }
    Json out = {
        {"type", "object"}, {"properties", properties}, {"required", required}, {"additionalProperties", false}};
    if (!paths.is_null()) out["patternProperties"] = paths;
    return out;
  }

  Json level_json(const SchemaLevel& level) const {
    if (level.cases.size() == 1) return case_json(level.cases.front());
    Json all = Json::array();
    for (const SchemaCase& c : level.cases) all.push_back(case_json(c));
    return {{"anyOf", all}};
  }

  const Schema& schema_;
  std::string prefix_;
};

}  // namespace

std::string schema_table(const NamedSchema& named) {
  std::string text = fmt::format("{}\n", named.name);
  for (const SchemaLevel& level : named.schema.levels) text += level_table(level, named.schema);
  return text;
}

std::string schema_json(const std::vector<NamedSchema>& all, const std::string& title) {
  Json definitions = Json::object(), files = Json::array();
  for (const NamedSchema& named : all) files.push_back(JsonSchema(named, definitions).reference(0));
  const Json whole = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                      {"title", title},
                      {"anyOf", files},
                      {"$defs", definitions}};
  return whole.dump(1) + "\n";
}

std::string law_lines() {
  const Schema along = law_schema(false), about = law_schema(true);
  const auto fields = [](const SchemaCase& c) {
    std::string text;
    for (const SchemaField& f : c.fields) {
      if (f.key == "law") continue;
      const std::vector<std::string> units = units_of(f.dimension);
      const std::string unit = f.kind == FieldKind::pairs
                                   ? fmt::format(" [{}, {}]", units.front(), units_of(*f.second).front())
                               : f.kind != FieldKind::quantity || units.empty() ? ""
                                                                                : " " + units.front();
      text += fmt::format("{}{}{}{}", text.empty() ? "" : ", ", f.key, unit, f.required ? "" : " (may be absent)");
    }
    return text;
  };
  const auto name = [](const SchemaCase& c) {
    std::string text = c.choices.at("law").front();
    for (const auto& [key, words] : c.choices)
      if (key != "law") text += " with " + words.front();
    return text;
  };
  std::string text;
  for (const SchemaCase& c : along.levels.front().cases) {
    const auto turned = std::find_if(about.levels.front().cases.begin(), about.levels.front().cases.end(),
                                     [&](const SchemaCase& other) { return name(other) == name(c); });
    const bool turns = turned != about.levels.front().cases.end();
    text += fmt::format("\n{}: {}", name(c), fields(c));
    if (!turns) text += " (along an axis only)";
    if (turns && fields(*turned) != fields(c)) text += "; about an axis: " + fields(*turned);
  }
  return text;
}

}  // namespace deflect::report
