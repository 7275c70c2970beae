#pragma once
/// @file
/// Reading what may not be there, and numbers as people read them.

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace tautline::output::detail {

using Figure = std::optional<double>;

/// The member of that name; null if `object` is no object or lacks it.
const nlohmann::ordered_json& member(const nlohmann::ordered_json& object, const char* name);

/// The entry of that index; null if `list` is no list or too short.
const nlohmann::ordered_json& entry(const nlohmann::ordered_json& list, std::size_t index);

Figure number(const nlohmann::ordered_json& value);
/// A text as it is, any other scalar as JSON writes it, "" for null and for structures.
std::string text(const nlohmann::ordered_json& value);
/// An entry of results.json's `warnings` as a sentence.
std::string warning_text(const nlohmann::ordered_json& warning);

/// `scale` times the value with `digits` significant digits and a space before the unit; whole numbers
/// without decimals; "-" if there is none.
std::string show(const nlohmann::ordered_json& value, const char* unit = "", double scale = 1,
                 int digits = 4);
std::string show(Figure value, const char* unit = "", double scale = 1, int digits = 4);

/// Figures that stand in one column, all in one notation: as many decimals as give the largest `digits`
/// significant digits, one more if a smaller one needs it; powers of ten where they differ by six orders.
std::vector<std::string> show_column(const std::vector<Figure>& values, double scale = 1, int digits = 4);

/// "1 pass", "3 passes".
std::string counted(const nlohmann::ordered_json& count, const std::string& one, const std::string& many);

/// "constraint_residual" as "constraint residual".
std::string words(std::string name);

/// The name with its first letter large.
std::string capitalised(std::string name);

}  // namespace tautline::output::detail
