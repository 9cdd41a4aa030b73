// Tables of numbers in text files, line by line, with errors that name the line.

#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace craze::io {

/// The whole of a text file, gunzipped if it is compressed.
/// @throws InvalidInput  when it cannot be read or is damaged
std::string read_text_gz(const std::filesystem::path& file);

/// The text without blanks, tabs and carriage returns at its ends.
std::string trimmed(const std::string& text);

/// Walks over the lines of a text and the words of each.
class TextLines {
public:
    /// @param separators  what stands between words, besides blanks and tabs
    TextLines(std::filesystem::path file, std::string_view separators = "");

    /// The next line that holds a word; comments are kept in comment(), apart from words. False at the end.
    bool next();
    /// The next line, even if it is empty or a comment.
    bool next_raw();
    const std::vector<std::string_view>& words() const { return words_; }
    std::string_view line() const { return line_; }
    /// What follows the first # of the line.
    std::string_view comment() const { return comment_; }
    std::int64_t number() const { return number_; }  ///< of the line, from 1
    const std::filesystem::path& file() const { return file_; }

    /// Word k as a number.
    /// @throws InvalidInput  naming file, line and `what`
    double real(std::size_t k, std::string_view what) const;
    std::int64_t integer(std::size_t k, std::string_view what) const;
    /// @throws InvalidInput  naming file and line
    [[noreturn]] void refuse(const std::string& why) const;

private:
    std::filesystem::path file_;
    std::string text_, separators_;
    std::size_t position_ = 0;
    std::int64_t number_ = 0;
    std::string_view line_, comment_;
    std::vector<std::string_view> words_;
};

}  // namespace craze::io
