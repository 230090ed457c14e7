// The keys of device and frame files as a table for people and as JSON Schema for editors.
#pragma once

#include <string>
#include <vector>

#include "msa/fields/schema.h"

namespace deflect::report {

/// A kind of file: "device, family chains", with its keys.
struct NamedSchema {
  std::string name;
  Schema schema;
};

/// Every level with its keys: type and unit, default or that it must be there, one line.
std::string schema_table(const NamedSchema&);

/// JSON Schema, draft 2020-12: a file is one of these. Keys that are not there are refused, as the reader refuses them.
std::string schema_json(const std::vector<NamedSchema>&, const std::string& title);

/// One line for each law: "belt: specific_stiffness (N/mm), width (mm), …"; on a rotation what differs.
std::string law_lines();

}  // namespace deflect::report
