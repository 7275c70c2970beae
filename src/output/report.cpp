#include <tautline/output/report.hpp>

#include <algorithm>
#include <filesystem>
#include <set>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <tautline/output/results.hpp>
#include "output/detail/base64.hpp"
#include "output/detail/comparison.hpp"
#include "output/detail/figures.hpp"
#include "output/detail/files.hpp"
#include "output/detail/layout.hpp"
#include "output/detail/markup.hpp"
#include "output/detail/story.hpp"

namespace tautline::output {

namespace {

using Json = nlohmann::ordered_json;
using detail::escape_markup;
namespace fs = std::filesystem;

struct Picture {
  std::string path, caption, step;
};

/// The pictures that results.json names and are there, then whatever else lies in DIR/pictures.
std::vector<Picture> pictures_of(const std::string& directory, const Json& results) {
  std::vector<Picture> pictures;
  std::set<std::string> seen;
  const fs::path folder = fs::path(directory) / "pictures";
  std::error_code error;
  for (const auto& picture : detail::member(results, "pictures")) {
    const fs::path file = folder / fs::path(detail::text(detail::member(picture, "file"))).filename();
    if (!fs::is_regular_file(file, error) || !seen.insert(file.filename().string()).second) continue;
    pictures.push_back({file.string(), detail::text(detail::member(picture, "caption")),
                        detail::text(detail::member(picture, "step"))});
  }
  std::vector<Picture> others;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.path().extension() == ".png" && seen.count(entry.path().filename().string()) == 0)
      others.push_back({entry.path().string(), entry.path().stem().string(), ""});
  std::sort(others.begin(), others.end(), [](const Picture& a, const Picture& b) { return a.path < b.path; });
  pictures.insert(pictures.end(), others.begin(), others.end());
  return pictures;
}

/// A click or the space bar shows the picture as large as the window, and small again.
std::string figure(const Picture& picture) {
  const std::string caption = escape_markup(picture.caption);
  return fmt::format(
      "<figure><label><input type=\"checkbox\" aria-label=\"enlarge the picture\"><img alt=\"{0}\" "
      "src=\"data:image/png;base64,{1}\"></label><figcaption>{0}</figcaption></figure>\n",
      caption, detail::base64(detail::read_file(picture.path)));
}

std::string gallery(const std::string& figures) {
  return figures.empty() ? "" : "<div class=\"pictures\">\n" + figures + "</div>\n";
}

std::string figures_of(const std::vector<Picture>& pictures, const std::string& step) {
  std::string html;
  for (const auto& picture : pictures)
    if (picture.step == step) html += figure(picture);
  return html;
}

std::string badge(const std::string& status) {
  return fmt::format("<span class=\"status{}\">{}</span>", status == "done" ? " done" : "",
                     escape_markup(status));
}

std::string alarm(const std::string& text) {
  return fmt::format("<div class=\"alarm\" role=\"alert\">{}</div>\n", text);
}

std::string heading(const detail::Story& story, const Json& results) {
  std::string html = fmt::format("<h1>{} {}</h1>\n<p class=\"faint\">{}</p>\n", escape_markup(story.title),
                                 badge(story.status), escape_markup(story.deck));
  if (story.status != "done")
    html += alarm(fmt::format("<strong>This run is not complete: {}.</strong> {}",
                              escape_markup(story.status), escape_markup(story.reason)));
  for (const auto& warning : detail::member(results, "warnings"))
    html += alarm("<strong>Warning:</strong> " + escape_markup(detail::warning_text(warning)));
  return html + detail::html_cards(story.headline);
}

std::string tables(const std::vector<detail::Table>& tables) {
  std::string html;
  for (const auto& table : tables) html += detail::html_table(table);
  return detail::html_blocks(html);
}

/// What one step ended with.
std::string state(const detail::Chapter& step) {
  return detail::html_facts(step.surface, "Surface against the paraboloid") + tables(step.groups);
}

/// The last step that ended with a state, and the last modes; either may be lacking.
struct Ends {
  const detail::Chapter* state = nullptr;
  const detail::Chapter* modes = nullptr;
};

Ends ends_of(const detail::Story& story, const Json& results) {
  Ends ends;
  const auto name_of = [](const Json& step) { return detail::text(detail::member(step, "name")); };
  const std::string state = name_of(detail::last_step_with(results, {"groups", "surface"})),
                    modes = name_of(detail::last_step_with(results, {"frequencies"}));
  for (const auto& step : story.steps) {
    if (step.name.empty()) continue;
    if (step.name == state) ends.state = &step;
    if (step.name == modes) ends.modes = &step;
  }
  return ends;
}

/// @param whole whether the run came to its end
std::string final_section(const Ends& ends, bool whole, const std::vector<Picture>& pictures) {
  if (ends.state == nullptr && ends.modes == nullptr) return "";
  std::string html = fmt::format("<section>\n<h2>{} state", whole ? "Final" : "Last");
  if (ends.state != nullptr)
    html +=
        fmt::format(" <span class=\"faint\">after {}</span>", escape_markup(detail::words(ends.state->name)));
  html += "</h2>\n";
  const bool apart = ends.modes != nullptr && ends.modes != ends.state;
  std::string figures;
  if (ends.state != nullptr) figures += figures_of(pictures, ends.state->name);
  if (apart) figures += figures_of(pictures, ends.modes->name);
  html += gallery(figures);
  if (ends.state != nullptr) html += state(*ends.state);
  if (apart) html += tables(ends.modes->tables);
  return html + "</section>\n";
}

/// How a step went; what it ended with, too, unless the first section shows it.
std::string step_section(const detail::Chapter& step, const Ends& ends,
                         const std::vector<Picture>& pictures) {
  const std::string name = detail::capitalised(detail::words(step.name));
  std::string kind = step.kind == detail::words(step.name) ? "" : step.kind;
  if (!step.time.empty()) kind += (kind.empty() ? "" : ", ") + step.time;
  std::string html = fmt::format("<section>\n<h2>{} {} <span class=\"faint\">{}</span></h2>\n",
                                 escape_markup(name), badge(step.status), escape_markup(kind));
  if (!step.reason.empty()) {
    const std::string reason = escape_markup(step.reason);
    html += step.status == "done" ? fmt::format("<p>{}</p>\n", reason) : alarm(reason);
  }
  html += detail::html_facts(step.facts);
  if (&step == ends.modes && &step != ends.state)
    return html + "<p class=\"faint\">Modes: see above.</p>\n</section>\n";
  html += tables(step.tables);
  if (&step == ends.state)
    html += "<p class=\"faint\">Surface, forces and pictures: see above.</p>\n";
  else
    html += state(step) + gallery(figures_of(pictures, step.name));
  return html + "</section>\n";
}

std::string other_pictures(const detail::Story& story, const std::vector<Picture>& pictures) {
  std::string html;
  for (const auto& picture : pictures) {
    const bool shown = std::any_of(story.steps.begin(), story.steps.end(),
                                   [&](const detail::Chapter& step) { return step.name == picture.step; });
    if (!shown) html += figure(picture);
  }
  return html.empty() ? "" : "<section>\n<h2>Pictures</h2>\n" + gallery(html) + "</section>\n";
}

std::string single_report(const std::string& directory) {
  const Json results = read_results(directory + "/results.json");
  const auto story = detail::tell(results);
  const auto pictures = pictures_of(directory, results);
  const Ends ends = ends_of(story, results);
  std::string body = heading(story, results) + final_section(ends, story.status == "done", pictures);
  if (!story.model.empty())
    body += "<section>\n<h2>Structure</h2>\n" + detail::html_facts(story.model) + "</section>\n";
  for (const auto& step : story.steps) body += step_section(step, ends, pictures);
  body += other_pictures(story, pictures);
  body += "<section>\n<h2>Run</h2>\n" + detail::html_table(story.timings) +
          detail::html_facts(story.program) + "</section>\n";
  const std::string path = directory + "/report.html";
  detail::write_file(path, detail::html_page(story.title, body));
  return path;
}

std::string side_by_side(const std::vector<std::string>& directories) {
  std::string body = "<h1>Comparison</h1>\n" + detail::html_table(detail::comparison(directories));
  const std::string path = directories.front() + "/comparison.html";
  detail::write_file(path, detail::html_page("Comparison", body));
  return path;
}

}  // namespace

std::string write_report(const std::vector<std::string>& directories) {
  if (directories.empty()) throw std::invalid_argument("write_report needs a directory");
  return directories.size() == 1 ? single_report(directories.front()) : side_by_side(directories);
}

std::string comparison_text(const std::vector<std::string>& directories) {
  const auto table = detail::comparison(directories);
  std::string text;
  for (const auto& line : detail::table_lines(table, table.rows.size())) text += line + "\n";
  return text;
}

}  // namespace tautline::output
