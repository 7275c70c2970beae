#pragma once
/// @file
/// The deck: the file a user writes, read strictly into option structs. docs/deck/ is generated from the same
/// table.

#include <concepts>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <tautline/analysis/newton_options.hpp>
#include <tautline/model/model_options.hpp>
#include <tautline/output/output_options.hpp>
#include <tautline/reflector/perimeter_truss_options.hpp>
#include <tautline/reflector/tensegrity_rim_options.hpp>
#include <tautline/reflector/umbrella_options.hpp>
#include <tautline/reflector/y_umbrella_options.hpp>
#include <tautline/rod/rod_options.hpp>
#include <tautline/steps/step_options.hpp>

namespace tautline::deck {

/// The kinds of `reflector`.
using Reflector = std::variant<reflector::PerimeterTrussOptions, reflector::TensegrityRimOptions,
                               reflector::UmbrellaOptions, reflector::YUmbrellaOptions, rod::UmbrellaOptions>;

struct Deck {
  std::string path;
  std::string sha256;       ///< of the file's bytes, lower-case hex
  std::string fingerprint;  ///< of all that steps stand on: structure, supports, loads, with values put in
  std::vector<std::string> step_fingerprints;  ///< of each step
  std::string title;
  std::map<std::string, std::string> parameters;  ///< values in force, after --set
  std::optional<Reflector> reflector;             ///< exactly one of reflector and model is present
  std::optional<model::ModelOptions> model;
  std::map<std::string, model::MaterialOptions> materials;
  std::map<std::string, model::SectionOptions> sections;
  std::map<std::string, model::GroupOptions> groups;
  std::vector<model::SupportOptions> supports;
  std::vector<model::LoadOptions> loads;
  std::vector<steps::Step> steps;
  output::OutputOptions output;
  analysis::NewtonOptions solver;

  /// The reflector if it is a perimeter truss, or null.
  const reflector::PerimeterTrussOptions* truss() const {
    return reflector ? std::get_if<reflector::PerimeterTrussOptions>(&*reflector) : nullptr;
  }
  /// The reflector if it is a rim with struts on cords, or null.
  const reflector::TensegrityRimOptions* tensegrity_rim() const {
    return reflector ? std::get_if<reflector::TensegrityRimOptions>(&*reflector) : nullptr;
  }
  /// The reflector if it is an umbrella of spokes and nets, or null.
  const reflector::UmbrellaOptions* umbrella() const {
    return reflector ? std::get_if<reflector::UmbrellaOptions>(&*reflector) : nullptr;
  }
  /// The reflector if it is an umbrella with Y-shaped spokes, or null.
  const reflector::YUmbrellaOptions* y_umbrella() const {
    return reflector ? std::get_if<reflector::YUmbrellaOptions>(&*reflector) : nullptr;
  }
  /// What reflectors of nets and ties have in common, or null.
  const reflector::DishOptions* dish() const {
    const auto as_dish = []<class Options>(const Options& options) -> const reflector::DishOptions* {
      if constexpr (std::derived_from<Options, reflector::DishOptions>)
        return &options;
      else
        return nullptr;
    };
    return reflector ? std::visit(as_dish, *reflector) : nullptr;
  }
  /// The reflector if it is an umbrella of rods, or null.
  const rod::UmbrellaOptions* rod_umbrella() const {
    return reflector ? std::get_if<rod::UmbrellaOptions>(&*reflector) : nullptr;
  }
};

/// @brief Reads and checks a deck: syntax, keys, types, units, ranges, cross references between its blocks.
/// @param overrides  "path.to.key=value" as given by --set; `parameters.s=8` or any scalar key
/// (`reflector.gap=0.05`, `steps.1.subdivisions=8`)
/// @throws DeckError with every complaint at once (at most 20 are shown)
Deck read_deck(const std::string& path, const std::vector<std::string>& overrides = {});

/// The same from text; `name` stands for the file in messages.
Deck parse_deck(const std::string& text, const std::string& name,
                const std::vector<std::string>& overrides = {});

/// What a key means: type, unit, default, range, sentence. Empty key: the whole table of contents.
/// @throws DeckError with a suggestion for an unknown key
std::string explain(const std::string& key);

/// JSON schema of the deck, draft 2020-12.
std::string schema();

/// A commented starting deck; `kinds()` lists the names. @throws DeckError for an unknown kind.
std::string starting_deck(const std::string& kind);
std::vector<std::string> starting_deck_kinds();

/// docs/deck/*.md from the keyword table: file name -> text.
std::map<std::string, std::string> reference_pages();

}  // namespace tautline::deck
