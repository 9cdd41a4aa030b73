// A folder of numbered slices, one file each.

#include "craze/core/progress.hpp"
#include "craze/io/volume_formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>

namespace craze::io {

namespace fs = std::filesystem;

namespace {

// "PREFIX0042SUFFIX": the last run of digits of the name is the number of the slice.
struct Numbered {
    fs::path file;
    std::string prefix, suffix;
    std::optional<std::int64_t> number;
};

Numbered number_of(const fs::path& file)
{
    const std::string name = file.filename().string();
    const auto stem = static_cast<std::ptrdiff_t>(file.stem().string().size());
    const auto digit = [](char c) { return c >= '0' && c <= '9'; };
    const auto last = std::find_if(std::make_reverse_iterator(name.begin() + stem), name.rend(), digit).base();
    const auto first = std::find_if_not(std::make_reverse_iterator(last), name.rend(), digit).base();
    Numbered slice{file, {name.begin(), first}, {last, name.end()}, {}};
    if (last - first > 0 && last - first < 18) slice.number = std::stoll(std::string(first, last));
    return slice;
}

std::string extension_of(const fs::path& file)
{
    std::string extension = file.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension == ".tiff" ? ".tif" : extension;
}

// Gaps in the numbering are worth a word: a lost slice shortens cracks along z.
void report_gaps(const fs::path& folder, const std::vector<Numbered>& slices)
{
    std::int64_t missing = 0;
    std::string first_gaps;
    int gaps = 0;
    for (std::size_t i = 1; i < slices.size(); ++i) {
        const Numbered &a = slices[i - 1], &b = slices[i];
        if (!a.number || !b.number || a.prefix != b.prefix || *b.number <= *a.number + 1) continue;
        missing += *b.number - *a.number - 1;
        if (++gaps <= 5)
            first_gaps +=
                fmt::format("{}{}", gaps > 1 ? ", " : "",
                            *b.number == *a.number + 2 ? fmt::format("{}", *a.number + 1)
                                                       : fmt::format("{} to {}", *a.number + 1, *b.number - 1));
    }
    if (missing > 0)
        notice(fmt::format("{}: {} slice{} missing in the numbering ({}{}); the stack closes up over the gap",
                           folder.string(), missing, missing > 1 ? "s are" : " is", first_gaps,
                           gaps > 5 ? ", ..." : ""));
}

std::vector<Numbered> slices_of(const fs::path& folder)
{
    std::map<std::string, std::vector<Numbered>> by_kind;
    for (const auto& entry : fs::directory_iterator(folder)) {
        const std::string kind = extension_of(entry.path());
        const bool hidden = entry.path().filename().string().starts_with(".");
        if (entry.is_regular_file() && !hidden && (kind == ".tif" || kind == ".png"))
            by_kind[kind].push_back(number_of(entry.path()));
    }
    if (by_kind.empty()) refuse(folder, "needed a folder with .tif or .png slices, found none in it");
    if (by_kind.size() > 1)
        refuse(folder, fmt::format("holds both .tif ({}) and .png ({}) files; leave only the slices",
                                   by_kind[".tif"].size(), by_kind[".png"].size()));
    std::vector<Numbered> slices = std::move(by_kind.begin()->second);
    std::sort(slices.begin(), slices.end(), [](const Numbered& a, const Numbered& b) {
        return natural_less(a.file.filename().string(), b.file.filename().string());
    });
    for (std::size_t i = 1; i < slices.size(); ++i)
        if (slices[i].prefix == slices[i - 1].prefix && slices[i].number && slices[i].number == slices[i - 1].number)
            refuse(folder, fmt::format("{} and {} have the same number", slices[i - 1].file.filename().string(),
                                       slices[i].file.filename().string()));
    report_gaps(folder, slices);
    return slices;
}

ReaderPtr open_slice(const fs::path& file) { return extension_of(file) == ".png" ? open_png(file) : open_tiff(file); }

class FolderReader final : public VolumeReader {
public:
    explicit FolderReader(const fs::path& folder) : VolumeReader(folder, {}), slices_(slices_of(folder))
    {
        info_ = open_slice(slices_.front().file)->info();
        if (info_.shape.nz != 1)
            refuse(slices_.front().file, fmt::format("needed one slice per file, got {} pages", info_.shape.nz));
        for (const Numbered& slice : slices_) check(slice.file, open_slice(slice.file)->info());
        info_.shape.nz = static_cast<std::int64_t>(slices_.size());
        check_shape(folder, info_.shape);
    }

private:
    void check(const fs::path& file, const VolumeInfo& got) const
    {
        if (got.shape.nx != info_.shape.nx || got.shape.ny != info_.shape.ny || got.shape.nz != 1 ||
            got.sample != info_.sample)
            refuse(file,
                   fmt::format("differs from the first slice, {}: needed {} x {}, {}, got {} x {} x {}, {}",
                               slices_.front().file.filename().string(), info_.shape.nx, info_.shape.ny,
                               name_of(info_.sample), got.shape.nx, got.shape.ny, got.shape.nz, name_of(got.sample)));
    }

    void read(std::int64_t z, std::span<std::byte> to) override
    {
        const auto slice = open_slice(slices_[static_cast<std::size_t>(z)].file);
        check(slice->path(), slice->info());
        slice->read_slice(0, to);
    }

    std::vector<Numbered> slices_;
};

class FolderWriter final : public VolumeWriter {
public:
    FolderWriter(const fs::path& folder, const VolumeInfo& info) : VolumeWriter(folder, info)
    {
        fs::create_directories(folder);
        for (const auto& entry : fs::directory_iterator(folder))
            if (extension_of(entry.path()) == ".tif" || extension_of(entry.path()) == ".png")
                refuse(folder, "already holds slices; give an empty folder");
    }

private:
    void append(std::int64_t z, std::span<const std::byte> slice) override
    {
        const VolumeInfo one{{info_.shape.nx, info_.shape.ny, 1}, info_.sample, info_.voxel_size};
        const auto to = create_tiff(path_ / fmt::format("slice_{:05}.tif", z), one);
        to->append_slice(slice);
        to->finish();
    }
    void close() override {}
};

}  // namespace

ReaderPtr open_slice_folder(const fs::path& folder) { return std::make_unique<FolderReader>(folder); }

WriterPtr create_slice_folder(const fs::path& folder, const VolumeInfo& info)
{
    return std::make_unique<FolderWriter>(folder, info);
}

}  // namespace craze::io
