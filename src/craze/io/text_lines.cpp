#include "craze/io/text_lines.hpp"

#include "craze/core/errors.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <charconv>
#include <memory>

namespace craze::io {

namespace fs = std::filesystem;

std::string read_text_gz(const fs::path& file)
{
    if (!fs::is_regular_file(file)) throw InvalidInput(fmt::format("{}: not found", file.string()));
    const std::unique_ptr<gzFile_s, int (*)(gzFile)> in(gzopen(file.c_str(), "rb"), gzclose);
    if (!in) throw InvalidInput(fmt::format("{}: cannot be read", file.string()));
    std::string text;
    constexpr unsigned piece = 1U << 20U;
    for (;;) {
        const std::size_t before = text.size();
        text.resize(before + piece);
        const int got = gzread(in.get(), text.data() + before, piece);
        int error = Z_OK;
        gzerror(in.get(), &error);
        if (got < 0 || (error != Z_OK && error != Z_STREAM_END))
            throw InvalidInput(fmt::format("{}: damaged or truncated", file.string()));
        text.resize(before + static_cast<std::size_t>(got));
        if (got == 0) return text;
    }
}

std::string trimmed(const std::string& text)
{
    const auto first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
    return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

TextLines::TextLines(fs::path file, std::string_view separators)
    : file_(std::move(file)), text_(read_text_gz(file_)), separators_(" \t\r" + std::string(separators))
{
}

bool TextLines::next_raw()
{
    if (position_ >= text_.size()) return false;
    const std::size_t end = std::min(text_.find('\n', position_), text_.size());
    line_ = std::string_view(text_).substr(position_, end - position_);
    position_ = end + 1;
    ++number_;
    const std::size_t hash = std::min(line_.find('#'), line_.size());
    comment_ = hash < line_.size() ? line_.substr(hash + 1) : std::string_view{};
    words_.clear();
    const std::string_view content = line_.substr(0, hash);
    for (std::size_t at = content.find_first_not_of(separators_); at != std::string_view::npos;) {
        const std::size_t stop = std::min(content.find_first_of(separators_, at), content.size());
        words_.push_back(content.substr(at, stop - at));
        at = content.find_first_not_of(separators_, stop);
    }
    return true;
}

bool TextLines::next()
{
    while (next_raw())
        if (!words_.empty()) return true;
    return false;
}

void TextLines::refuse(const std::string& why) const
{
    throw InvalidInput(fmt::format("{}, line {}: {}", file_.string(), number_, why));
}

double TextLines::real(std::size_t k, std::string_view what) const
{
    if (k >= words_.size()) refuse(fmt::format("needs {} as word {}, the line has {}", what, k + 1, words_.size()));
    double value = 0.0;
    const auto [end, error] = std::from_chars(words_[k].data(), words_[k].data() + words_[k].size(), value);
    if (error != std::errc{} || end != words_[k].data() + words_[k].size())
        refuse(fmt::format("needs a number for {}, got \"{}\"", what, words_[k]));
    return value;
}

std::int64_t TextLines::integer(std::size_t k, std::string_view what) const
{
    if (k >= words_.size()) refuse(fmt::format("needs {} as word {}, the line has {}", what, k + 1, words_.size()));
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(words_[k].data(), words_[k].data() + words_[k].size(), value);
    if (error != std::errc{} || end != words_[k].data() + words_[k].size())
        refuse(fmt::format("needs a whole number for {}, got \"{}\"", what, words_[k]));
    return value;
}

}  // namespace craze::io
