// JSON as results are written: keys in the order of the contract, numbers that read back exactly, one line
// for what is a row of numbers.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "msa/base/spatial.h"

namespace deflect::json {

using Json = nlohmann::ordered_json;

/// The number, or a NumericalError naming `what` where it is NaN or infinite, which JSON cannot hold.
Json json_number(double value, const std::string& what);

/// [6 numbers] and [[6×6]] by rows.
Json json_numbers(const Vector6& values, const std::string& what);
Json json_rows(const Matrix6& values, const std::string& what);

/// The JSON of a file. InputError "origin:line: …" with the remedy where it is none, is nested too deep to be followed
/// or holds a number that no double holds.
Json parse_json(const std::string& text, const std::string& origin, const std::string& remedy);

/// One line without spaces. Here and below, bytes that are no UTF-8, as the name of a file can have, become U+FFFD.
std::string compact(const Json&);

/// Indented by two; a list of plain values, or an object in a list, stays on one line.
std::string json_text(const Json& value);

}  // namespace deflect::json

namespace deflect {
/// A word of all rooms that read or write results, as Vector6 is: `json::Json` would say it twice.
using json::Json;
}  // namespace deflect
