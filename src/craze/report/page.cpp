#include "craze/report/page.hpp"

#include "craze/core/json.hpp"
#include "craze/core/version.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/report/assets.hpp"

#include <fmt/format.h>

namespace craze::report {

namespace fs = std::filesystem;

namespace {

/// The form that files carry: black on white whatever surrounds it.
std::string standalone(std::string svg)
{
    svg.insert(svg.find('>'), " color=\"#000\" style=\"background:#fff\"");
    return svg;
}

std::string link(std::string_view name, std::string_view type, std::string_view bytes)
{
    const auto dot = name.rfind('.');
    return fmt::format("<a download=\"{}\" href=\"{}\">{}</a> ", escape(name), data_uri(type, bytes),
                       escape(name.substr(dot + 1)));
}

}  // namespace

Page::Page(std::string title, fs::path folder) : title_(std::move(title)), folder_(std::move(folder))
{
    fs::create_directories(folder_ / "figures");
}

void Page::section(std::string_view id, std::string_view title)
{
    if (open_) body_ += "</section>\n";
    open_ = true;
    nav_ += fmt::format("<a href=\"#{}\">{}</a>\n", id, escape(title));
    body_ += fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n", id, escape(title));
}

void Page::subtitle(std::string_view title) { body_ += "<h3>" + escape(title) + "</h3>\n"; }
void Page::add(std::string_view html) { body_ += html; }
void Page::text(std::string_view plain) { body_ += "<p>" + escape(plain) + "</p>\n"; }
void Page::remark(std::string_view plain) { body_ += "<p class=\"remark\">" + escape(plain) + "</p>\n"; }

void Page::folded(std::string_view plain, std::string_view html)
{
    body_ += fmt::format("<details><summary>{}</summary>\n{}</details>\n", escape(plain), html);
}

void Page::caption_and_links(std::string_view id, std::string_view caption, std::string_view paper,
                             std::string_view links)
{
    body_ += fmt::format(
        "<figcaption>{}{} <span class=\"links\" data-id=\"{}\">{}</span></figcaption></figure>\n",
        paper.empty() ? std::string() : fmt::format("<span class=\"paper\">{} of the paper</span> ", escape(paper)),
        escape(caption), escape(id), links);
}

void Page::figure(const Figure& figure)
{
    if (figure.empty()) return;
    const auto drawing = svg(figure), table = csv(figure);
    io::write_text(folder_ / "figures" / (figure.id + ".svg"), standalone(drawing));
    io::write_text(folder_ / "figures" / (figure.id + ".csv"), table);
    body_ += fmt::format(
        "<figure class=\"plot\" id=\"{}\"><div class=\"drawing\">{}</div>"
        "<script type=\"application/json\">{}</script>",
        escape(figure.id), drawing, script_json(to_json(figure)));
    caption_and_links(figure.id, figure.caption, figure.paper, link(figure.id + ".csv", "text/csv", table));
}

void Page::figure(const Rose& rose)
{
    if (rose.share.empty()) return;
    const auto drawing = svg(rose), table = csv(rose);
    io::write_text(folder_ / "figures" / (rose.id + ".svg"), standalone(drawing));
    io::write_text(folder_ / "figures" / (rose.id + ".csv"), table);
    body_ += fmt::format("<figure class=\"rose\" id=\"{}\"><div class=\"drawing\">{}</div>", escape(rose.id), drawing);
    caption_and_links(rose.id, rose.caption, rose.paper, link(rose.id + ".csv", "text/csv", table));
}

std::string Page::image(std::string_view id, std::string_view png, std::string_view caption)
{
    io::write_text(folder_ / "figures" / fmt::format("{}.png", id), png);
    return fmt::format("<img alt=\"{}\" src=\"{}\">", escape(caption), data_uri("image/png", png));
}

void Page::picture(std::string_view id, std::string_view png, std::string_view caption, std::string_view paper)
{
    body_ += fmt::format("<figure class=\"picture\" id=\"{}\">{}", escape(id), image(id, png, caption));
    caption_and_links(id, caption, paper, "");
}

void Page::drawing(std::string_view id, std::string_view svg, std::string_view caption, std::string_view paper)
{
    io::write_text(folder_ / "figures" / fmt::format("{}.svg", id), svg);
    body_ += fmt::format("<figure class=\"picture foreign\" id=\"{}\"><img alt=\"{}\" src=\"{}\">", escape(id),
                         escape(caption), data_uri("image/svg+xml", svg));
    caption_and_links(id, caption, paper, "");
}

void Page::viewer(std::string_view id, std::string_view kind, const Json& data, std::string_view caption,
                  std::string_view still, std::string_view paper)
{
    body_ += fmt::format(
        "<figure class=\"viewer {}\" id=\"{}\"><div class=\"drawing\">{}</div>"
        "<script type=\"application/json\">{}</script>",
        escape(kind), escape(id), image(id, still, caption), script_json(data));
    caption_and_links(id, caption, paper, "");
}

std::string Page::finish() const
{
    std::string out = "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
    out +=
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data: blob:; "
        "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n";
    out += fmt::format("<meta name=\"generator\" content=\"craze {}\">\n<title>{}</title>\n", version, escape(title_));
    out += fmt::format(
        "<style>{}</style>\n</head>\n<body>\n<nav>\n<strong>craze</strong>\n{}</nav>\n<main>\n<h1>{}</h1>\n",
        page_style(), nav_, escape(title_));
    out += body_;
    if (open_) out += "</section>\n";
    out += fmt::format("<footer>Written by craze {}.</footer>\n</main>\n", version);
    if (!page_script().empty()) out += fmt::format("<script>{}</script>\n", page_script());
    return out + "</body>\n</html>\n";
}

}  // namespace craze::report
