#include "craze/pipeline/settings.hpp"

namespace craze::pipeline {

void describe(Schema& schema, Settings& s)
{
    schema.group("synth", "an artificial coating under an artificial microscope; used when images.source is empty",
                 [&] { synth::describe(schema, s.synth); });
    schema.group("images", "from a raw stack to gray levels one can trust [2.3]",
                 [&] { images::describe(schema, s.images); });
    schema.group("microstructure", "which void is a pore, which a crack [2.4, 2.6]",
                 [&] { microstructure::describe(schema, s.microstructure); });
    schema.group("mesh", "the sheet that each crack is [2.5]", [&] { mesh::describe(schema, s.mesh); });
    schema.group("domain", "elements and bonds that stand for the matter [3]",
                 [&] { domain::describe(schema, s.domain); });
    schema.group("loading", "virtual tests [3.1.2, 4]", [&] { loading::describe(schema, s.loading); });
    schema.group("report", "one page with pictures and curves", [&] { report::describe(schema, s.report); });
}

void check(const Settings& s)
{
    images::Settings images = s.images;
    if (s.synthetic()) {
        synth::check(s.synth);
        images.source = ".";  // the stack is made later; anything that exists will do
    }
    if (!s.without_images()) images::check(images);
    microstructure::check(s.microstructure);
    mesh::check(s.mesh);
    domain::check(s.domain);
    loading::check(s.loading);
    report::check(s.report);
}

Settings read(const SettingsSource& source)
{
    Settings settings;
    read_settings(source, [&](Schema& schema) { describe(schema, settings); });
    check(settings);
    return settings;
}

}  // namespace craze::pipeline
