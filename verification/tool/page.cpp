#include "page.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

namespace verify {

namespace {

std::string row(const Result& r, const std::string& mark) {
  return fmt::format("| {}{} | {} | {} | {} | {} | {} | {} |\n", with_unit(r.quantity), mark,
                     number_text(r.ours), reference_text(r), difference_text(r), tolerance_text(r.quantity),
                     to_string(r.quantity.origin), verdict(r));
}

constexpr const char* header =
    "| quantity | ours | reference | difference | tolerance | origin of the reference | "
    "|\n|---|---|---|---|---|---|---|\n";

std::string read_file(const std::string& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

std::string title(const Case& c) {
  std::istringstream readme(read_file(c.directory + "/README.md"));
  std::string line;
  std::getline(readme, line);
  return line.rfind("# ", 0) == 0 ? line.substr(2) : c.name;
}

std::string command(const Run& run) {
  std::string text = run.ranks > 1 ? fmt::format("mpirun -n {} ", run.ranks) : "";
  text += "tautline run " + run.deck;
  for (const auto& o : run.overrides) text += " --set " + o;
  return text;
}

}  // namespace

std::string number_text(double value) {
  if (value != 0 && std::abs(value) < 1e-3) return fmt::format("{:.3g}", value);
  return fmt::format("{:.5g}", value);
}

std::string reference_text(const Result& r) {
  const auto& text = r.quantity.reference;
  const bool plain = text.find_first_not_of("0123456789.eE+-") == std::string::npos;
  const char* sign = r.quantity.check == Check::at_most    ? "≤ "
                     : r.quantity.check == Check::at_least ? "≥ "
                                                           : "";
  return sign + (plain ? text : number_text(r.reference));
}

std::string with_unit(const Quantity& quantity) {
  return quantity.unit.empty() ? quantity.name : fmt::format("{} [{}]", quantity.name, quantity.unit);
}

std::string difference_text(const Result& r) {
  const double difference = r.ours - r.reference;
  if (r.quantity.check == Check::at_most || r.quantity.check == Check::at_least) return "";
  if (r.quantity.absolute || r.reference == 0) return fmt::format("{:+.2g}", difference);
  const double percent = 100 * difference / std::abs(r.reference);
  return std::abs(percent) < 0.01 ? fmt::format("{:+.1e}", percent / 100) : fmt::format("{:+.2f} %", percent);
}

std::string tolerance_text(const Quantity& q) {
  if (q.relative)
    return *q.relative >= 1e-4 ? fmt::format("{:.3g} %", 100 * *q.relative)
                               : fmt::format("{:.0e} relative", *q.relative);
  if (q.absolute) return fmt::format("{:.2g}{}{}", *q.absolute, q.unit.empty() ? "" : " ", q.unit);
  return "";
}

std::string verdict(const Result& r) {
  if (!r.problem.empty()) return "FAILED: " + r.problem;
  if (r.quantity.check == Check::report_only) return "shown";
  return r.passed ? "ok" : "**FAILED**";
}

std::string case_page(const CaseResults& results) {
  const std::string source = fmt::format("verification/{}", results.the_case.name);
  std::string page = fmt::format("<!-- Made by tautline_verify from {}; do not edit. -->\n\n", source);
  page += read_file(results.the_case.directory + "/README.md") + "\n## Ours and theirs\n\n";
  page += header;
  std::string notes;
  int n_notes = 0;
  for (const auto& r : results.results) {
    std::string mark;
    if (!r.quantity.note.empty()) {
      mark = fmt::format(" <sup>{}</sup>", ++n_notes);
      notes += fmt::format("{}. {}: {}\n", n_notes, r.quantity.name, r.quantity.note);
    }
    page += row(r, mark);
  }
  page += "\n\"shown\" is reported beside its reference, not asserted; the note says why.\n";
  if (!notes.empty()) page += "\n## Notes\n\n" + notes;
  page += "\n## Sources of the references\n\n";
  std::vector<std::string> seen;
  for (const auto& r : results.results)
    if (const auto& s = r.quantity.source;
        !s.empty() && std::find(seen.begin(), seen.end(), s) == seen.end()) {
      seen.push_back(s);
      page += "- " + s + "\n";
    }
  page += "\n## Runs\n\n```\n";
  for (const auto& run : results.the_case.runs) page += fmt::format("{:<14} {}\n", run.name, command(run));
  page += "```\n\nDecks that are not in `inputs/` are in `" + source + "/`, with `expected.yaml`.\n";
  return page;
}

std::string overview_page(const std::vector<CaseResults>& cases, const std::string& source) {
  std::string page =
      "<!-- Made by tautline_verify; do not edit. -->\n\n# Verification\n\nWhat the program computes beside "
      "what is known. Each reference "
      "says where it comes from: `analytic` (a formula), `invariant` (what must hold whatever the answer is, as "
      "the balance of loads and reactions), `published`, `other_code` (an independent program), "
      "`regression` (a recorded value of our own, "
      "no evidence), `requirement` (what this project asks of itself). \"shown\" is reported, not asserted; "
      "the case's page says why.\n\n"
      "Run it with `ctest --preset release -L verification`; `cmake --build --preset release --target "
      "verification_docs` "
      "makes these pages again.\n";
  for (const auto& c : cases) {
    page += fmt::format("\n## [{}](verification/{}.md)\n\n", title(c.the_case), c.the_case.name);
    page += header;
    for (const auto& r : c.results) page += row(r, "");
  }
  return page + "\n" + read_file(source + "/verification/mutants.md");
}

}  // namespace verify
