// The page as it grows: sections of tables, figures, pictures, slices and scenes; the same things as files beside it.

#pragma once

#include "craze/core/json_fwd.hpp"
#include "craze/report/figure.hpp"
#include "craze/report/html.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace craze::report {

class Page {
public:
    /// @param folder  <out>/report; figures/ is made in it
    Page(std::string title, std::filesystem::path folder);

    /// Begins a section; what follows belongs to it.
    void section(std::string_view id, std::string_view title);
    void subtitle(std::string_view title);
    /// HTML as it is.
    void add(std::string_view html);
    /// A paragraph of plain text.
    void text(std::string_view plain);
    /// A paragraph that says what is missing or wrong.
    void remark(std::string_view plain);
    /// HTML folded away behind a line of text.
    void folded(std::string_view plain, std::string_view html);

    /// Plots share rows; an empty one leaves no trace.
    void figure(const Figure& figure);
    void figure(const Rose& rose);
    /// A PNG, also written to figures/<id>.png.
    void picture(std::string_view id, std::string_view png, std::string_view caption, std::string_view paper = "");
    /// An SVG made elsewhere, also written to figures/<id>.svg; black on white whatever surrounds it.
    void drawing(std::string_view id, std::string_view svg, std::string_view caption, std::string_view paper = "");
    /// Data that the page's script turns into a viewer of the given kind ("slices", "scene"). `still` is a PNG shown
    /// until then, in print, and where it cannot; it is also written to figures/<id>.png.
    void viewer(std::string_view id, std::string_view kind, const Json& data, std::string_view caption,
                std::string_view still, std::string_view paper = "");

    /// The whole document.
    std::string finish() const;

private:
    std::string image(std::string_view id, std::string_view png, std::string_view caption);
    void caption_and_links(std::string_view id, std::string_view caption, std::string_view paper,
                           std::string_view links);

    std::string title_, nav_, body_;
    std::filesystem::path folder_;
    bool open_ = false;
};

}  // namespace craze::report
