// A domain as a file tells it, each part with its line: not yet checked.

#pragma once

#include "craze/domain/domain.hpp"
#include "craze/domain/files.hpp"
#include "craze/io/text_lines.hpp"

#include <optional>
#include <string_view>
#include <vector>

namespace craze::domain {

struct Draft {
    struct Link {
        std::int64_t i = 0, j = 0;
        bool contact = false;
        double thickness = 0.0;
        std::int64_t line = 0;
    };
    Elements elements;
    std::vector<std::int64_t> element_line;
    std::vector<Link> bonds, near;
    bool has_bonds = false, has_near = false;
    std::filesystem::path elements_file, bonds_file, near_file;
    std::optional<Vec3> box;
    std::optional<double> mean_radius, dense_volume;

    void add_element(const io::TextLines& line, const Vec3& centre, double radius);
};

/// "box_m = 1 2 3", "mean_radius_m = 4" and "dense_volume_m3 = 5" in a comment.
void read_remark(std::string_view comment, Draft& draft);
/// The comment that read_remark understands.
std::vector<std::string> remarks(const Domain& domain);

void read_csv(const Source& source, Draft& draft);
void read_near_csv(const Source& source, Draft& draft);
void read_lammps(const Source& source, Draft& draft);
void read_yade(const Source& source, Draft& draft);
void read_listing(const Source& source, Draft& draft);

/// Checks the draft, in metres, and makes it a domain.
Domain finish(Draft draft, const Source& source);

}  // namespace craze::domain
