#include "craze/io/triangles.hpp"

#include "craze/core/errors.hpp"
#include "craze/io/atomic_file.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace craze::io {
namespace {

namespace fs = std::filesystem;

class Triangles : public testing::Test {
protected:
    void SetUp() override
    {
        folder_ = fs::temp_directory_path() /
                  (std::string("craze_") + testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    TriangleView view() const
    {
        return {vertices_, triangles_, {{"sides", std::span(tags_)}, {"crack", std::span(ids_)}}};
    }
    std::string refusal(const std::string& text) const
    {
        write_text(folder_ / "bad.ply", text);
        try {
            read_ply(folder_ / "bad.ply");
        } catch (const InvalidInput& error) {
            return error.what();
        }
        return "accepted";
    }

    const std::vector<Vec3> vertices_{{0, 0, 0}, {1.0 / 3.0, 0, 0}, {0, 1e-9, 0}, {0, 0, -2.5}};
    const std::vector<Corners> triangles_{{0, 1, 2}, {0, 3, 1}};
    const std::vector<std::uint8_t> tags_{2, 1};
    const std::vector<std::int32_t> ids_{7, -1};
    fs::path folder_;
};

TEST_F(Triangles, InPlyComeBackBitForBit)
{
    write_ply(folder_ / "a.ply", view());
    const TriangleMesh mesh = read_ply(folder_ / "a.ply", "sides");
    EXPECT_EQ(mesh.vertices, vertices_);
    EXPECT_EQ(mesh.triangles, triangles_);
    EXPECT_EQ(mesh.tags, tags_);
    EXPECT_TRUE(read_ply(folder_ / "a.ply").tags.empty());
}

TEST_F(Triangles, InPlyOfOtherProgramsAreRead)
{
    // As MeshLab writes them: float, normals and colours between, unsigned indices, another element after.
    std::string text =
        "ply\r\nformat binary_little_endian 1.0\r\ncomment VCGLIB generated\r\nelement vertex 3\r\nproperty float x\r\n"
        "property float y\r\nproperty float z\r\nproperty float nx\r\nproperty uchar red\r\nelement face 1\r\n"
        "property uchar flags\r\nproperty list uint8 uint32 vertex_index\r\nelement edge 1\r\nproperty list int short "
        "v\r\n"
        "end_header\r\n";
    const auto put = [&](auto value) {
        char raw[sizeof value];
        std::memcpy(raw, &value, sizeof value);
        text.append(raw, sizeof value);
    };
    for (int v = 0; v < 3; ++v) {
        for (int k = 0; k < 3; ++k) put(static_cast<float>(v + 10 * k));
        put(1.0F), put(std::uint8_t{9});
    }
    put(std::uint8_t{0}), put(std::uint8_t{3});
    for (const std::uint32_t v : {2U, 0U, 1U}) put(v);
    put(std::int32_t{2}), put(std::int16_t{0}), put(std::int16_t{1});
    write_text(folder_ / "b.ply", text);
    const TriangleMesh mesh = read_ply(folder_ / "b.ply");
    EXPECT_EQ(mesh.vertices, (std::vector<Vec3>{{0, 10, 20}, {1, 11, 21}, {2, 12, 22}}));
    EXPECT_EQ(mesh.triangles, (std::vector<Corners>{{2, 0, 1}}));
}

TEST_F(Triangles, OfADamagedPlyAreRefusedWithTheReason)
{
    EXPECT_NE(refusal("solid").find("not a PLY"), std::string::npos);
    EXPECT_NE(refusal("ply\nformat ascii 1.0\nend_header\n").find("needs binary_little_endian"), std::string::npos);
    EXPECT_NE(refusal("ply\nformat binary_little_endian 1.0\nelement vertex 9\nproperty double x\nend_header\n")
                  .find("ends too early"),
              std::string::npos);
    EXPECT_NE(
        refusal("ply\nformat binary_little_endian 1.0\nelement vertex 99999999999\nproperty double x\nend_header\n")
            .find("more than the file can hold"),
        std::string::npos);
    const std::string quad =
        "ply\nformat binary_little_endian 1.0\nelement face 1\nproperty list uchar uchar vertex_indices\nend_header\n";
    EXPECT_NE(refusal(quad + std::string("\4\0\0\0\0", 5)).find("needs triangles"), std::string::npos);
    EXPECT_NE(refusal(quad + std::string("\3\0\0\5", 4)).find("names vertex 0"), std::string::npos);
    EXPECT_THROW(read_ply(folder_ / "absent.ply"), InvalidInput);
    EXPECT_THROW(read_ply(folder_), InvalidInput);
}

TEST_F(Triangles, InStlHaveTheFormatsSizeAndNormals)
{
    write_stl(folder_ / "a.stl", view());
    const std::string bytes = read_text(folder_ / "a.stl");
    ASSERT_EQ(bytes.size(), 84U + 2U * 50U);
    EXPECT_NE(bytes.substr(0, 5), "solid");
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + 80, 4);
    EXPECT_EQ(count, 2U);
    float first[12];
    std::memcpy(first, bytes.data() + 84, sizeof first);
    EXPECT_EQ(first[2], 1.0F);  // normal along z
    EXPECT_EQ(first[6], 1.0F / 3.0F);
}

TEST_F(Triangles, InVtpLieWhereTheHeaderSays)
{
    write_vtp(folder_ / "a.vtp", view());
    const std::string bytes = read_text(folder_ / "a.vtp");
    const std::size_t data = bytes.find("encoding=\"raw\">\n_") + 17;
    const auto block = [&](const std::string& name) {
        const std::size_t tag = bytes.find("Name=\"" + name + "\"");
        return data + std::stoul(bytes.substr(bytes.find("offset=\"", tag) + 8));
    };
    std::uint64_t size = 0;
    std::memcpy(&size, bytes.data() + block("Points"), 8);
    EXPECT_EQ(size, 96U);
    double x = 0;
    std::memcpy(&x, bytes.data() + block("Points") + 8 + 24, 8);
    EXPECT_EQ(x, 1.0 / 3.0);
    std::memcpy(&size, bytes.data() + block("crack"), 8);
    EXPECT_EQ(size, 8U);
    std::int32_t id = 0;
    std::memcpy(&id, bytes.data() + block("crack") + 12, 4);
    EXPECT_EQ(id, -1);
    std::int64_t end = 0;
    std::memcpy(&end, bytes.data() + block("offsets") + 16, 8);
    EXPECT_EQ(end, 6);
    EXPECT_EQ(bytes.substr(block("crack") + 16), "\n  </AppendedData>\n</VTKFile>\n");
}

}  // namespace
}  // namespace craze::io
