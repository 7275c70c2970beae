#pragma once
/// @file
/// Reading what may not be there, and numbers as people read them.

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace tautline::output::detail {

/// The member of that name; null if `object` is no object or lacks it.
const nlohmann::ordered_json& member(const nlohmann::ordered_json& object, const char* name);

std::optional<double> number(const nlohmann::ordered_json& value);
/// A text as it is, any other scalar as JSON writes it, "" for null and for structures.
std::string text(const nlohmann::ordered_json& value);

/// `scale` times the value with `digits` significant digits and a space before the unit; "-" if there is
/// none.
std::string show(const nlohmann::ordered_json& value, const char* unit = "", double scale = 1,
                 int digits = 4);
std::string show(std::optional<double> value, const char* unit = "", double scale = 1, int digits = 4);

/// "constraint_residual" as "constraint residual".
std::string words(std::string name);

/// The name with its first letter large.
std::string capitalised(std::string name);

}  // namespace tautline::output::detail
