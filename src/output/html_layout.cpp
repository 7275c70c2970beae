#include <fmt/format.h>

#include "output/detail/figures.hpp"
#include "output/detail/layout.hpp"
#include "output/detail/markup.hpp"

namespace tautline::output::detail {

namespace {

constexpr std::size_t rows_without_folding = 16;

constexpr auto style = R"(
:root { color-scheme: light dark; --ink: #1d2129; --faint: #5d6572; --line: #dfe3e8; --paper: #ffffff; --card: #f4f6f9;
  --accent: #0b5aa0; --good: #19713f; --bad: #a8321c; --badpaper: #fdece8; }
@media (prefers-color-scheme: dark) { :root { --ink: #e6e9ee; --faint: #a0a8b4; --line: #353b45; --paper: #15181d;
  --card: #1f242c; --accent: #74b4ee; --good: #6cc893; --bad: #f09a86; --badpaper: #3a211c; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink); font: 15px/1.5 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; }
main { max-width: 1160px; margin: 0 auto; padding: 28px 22px 60px; }
h1 { font-size: 1.75rem; line-height: 1.2; margin: 0 0 4px; }
h2 { font-size: 1.25rem; margin: 40px 0 8px; padding-top: 10px; border-top: 1px solid var(--line); }
h2 .faint { font-size: .88rem; font-weight: 400; }
h3 { font-size: .95rem; margin: 12px 0 4px; }
p { margin: 4px 0 10px; }
.faint { color: var(--faint); overflow-wrap: anywhere; }
.status { display: inline-block; padding: 1px 10px; border-radius: 10px; font-size: .82rem; font-weight: 600;
  border: 1px solid currentColor; color: var(--bad); vertical-align: middle; }
.status.done { color: var(--good); }
.alarm { margin: 16px 0; padding: 12px 16px; border-left: 4px solid var(--bad); background: var(--badpaper); border-radius: 4px;
  white-space: pre-line; }
.cards { display: flex; flex-wrap: wrap; gap: 10px; margin: 18px 0 6px; }
.card { flex: 1 1 auto; background: var(--card); border-radius: 8px; padding: 10px 13px; white-space: nowrap; }
.card b { display: block; font-size: 1.2rem; line-height: 1.3; font-variant-numeric: tabular-nums; }
.card span { color: var(--faint); font-size: .84rem; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: .87rem; }
th, td { padding: 4px 0 4px 18px; text-align: right; border-bottom: 1px solid var(--line); }
th { color: var(--faint); font-weight: 600; vertical-align: bottom; }
th:first-child, td:first-child { text-align: left; padding-left: 0; }
td { white-space: nowrap; }
dl { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(310px, 100%), 1fr)); gap: 2px 30px; margin: 8px 0; }
dl div { display: flex; justify-content: space-between; gap: 14px; border-bottom: 1px solid var(--line); padding: 3px 0; }
dt { color: var(--faint); } dd { margin: 0; text-align: right; font-variant-numeric: tabular-nums; overflow-wrap: anywhere; }
.blocks { display: flex; flex-wrap: wrap; gap: 6px 40px; align-items: flex-start; margin: 10px 0 14px; }
.blocks > section { max-width: 100%; }
.pictures { columns: 2 440px; column-gap: 18px; margin: 16px 0; }
figure { margin: 0 0 18px; max-width: 640px; break-inside: avoid; }
figure img { display: block; width: 100%; height: auto; border-radius: 8px; border: 1px solid var(--line); background: #fff;
  cursor: zoom-in; }
figure input { position: absolute; opacity: 0; }
figure input:focus-visible + img { outline: 2px solid var(--accent); }
figure input:checked + img { position: fixed; inset: 0; width: 100vw; height: 100vh; object-fit: contain; z-index: 9;
  border-radius: 0; border: 0; cursor: zoom-out; }
figcaption { color: var(--faint); font-size: .86rem; line-height: 1.35; margin-top: 5px; }
summary { cursor: pointer; color: var(--accent); }
@media print { figure input { display: none; } main { max-width: none; padding: 0; } h2 { break-after: avoid; } figure, table, .card { break-inside: avoid; }
  .card { border: 1px solid #ccc; } }
)";

std::string cells(const Row& row, const char* tag) {
  std::string html = "<tr>";
  for (const auto& cell : row) html += fmt::format("<{0}>{1}</{0}>", tag, escape_markup(cell));
  return html + "</tr>\n";
}

}  // namespace

std::string html_table(const Table& table) {
  if (table.rows.empty()) return "";
  std::string html =
      "<div class=\"wide\"><table>\n<thead>" + cells(table.header, "th") + "</thead>\n<tbody>\n";
  for (const auto& row : table.rows) html += cells(row, "td");
  html += "</tbody></table></div>\n";
  if (table.title.empty()) return html;  // a page of its own: never folded
  if (table.rows.size() > rows_without_folding)
    html = fmt::format("<details><summary>{} rows</summary>\n{}</details>\n", table.rows.size(), html);
  return fmt::format("<section>\n<h3>{}</h3>\n{}</section>\n", escape_markup(table.title), html);
}

std::string html_blocks(const std::string& blocks) {
  return blocks.empty() ? "" : "<div class=\"blocks\">\n" + blocks + "</div>\n";
}

std::string html_facts(const std::vector<Fact>& facts, const std::string& title) {
  if (facts.empty()) return "";
  std::string html = title.empty() ? "" : fmt::format("<h3>{}</h3>\n", escape_markup(title));
  html += "<dl>\n";
  for (const auto& [label, value] : facts)
    html += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", escape_markup(label), escape_markup(value));
  return html + "</dl>\n";
}

std::string html_cards(const std::vector<Fact>& facts) {
  if (facts.empty()) return "";
  std::string html = "<div class=\"cards\">\n";
  for (const auto& [label, value] : facts)
    html += fmt::format("<div class=\"card\"><b>{}</b><span>{}</span></div>\n", escape_markup(value),
                        escape_markup(label));
  return html + "</div>\n";
}

std::string html_page(const std::string& title, const std::string& body) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, "
      "initial-scale=1\">\n<title>{}</title>\n<style>{}</style>\n"
      "</head>\n<body>\n<main>\n{}</main>\n</body>\n</html>\n",
      escape_markup(title), style, body);
}

}  // namespace tautline::output::detail
