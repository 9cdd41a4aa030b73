#include "craze/reproduce/settings.hpp"

namespace craze::reproduce {

namespace {

void describe_studies(Schema& schema, AllSettings& s)
{
    schema.group("reproduce", "craze reproduce: the paper's numbers beside ours",
                 [&] { describe(schema, s.reproduce); });
    schema.group("fit", "craze fit-coating: a search for the paper's coating", [&] { describe(schema, s.fit); });
}

}  // namespace

void describe(Schema& schema, AllSettings& s)
{
    schema.group("synth", "the recipe of the coating", [&] { synth::describe(schema, s.synth); });
    describe_studies(schema, s);
}

AllSettings read(const pipeline::SettingsSource& source)
{
    AllSettings s;
    pipeline::read_settings(source, [&](Schema& schema) { describe(schema, s); });
    synth::check(s.synth);
    check(s.reproduce);
    check(s.fit);
    return s;
}

std::string settings_reference()
{
    AllSettings s;
    return "\nThe recipe of `craze reproduce` and `craze fit-coating` is a file with `[synth]` and, if wished, "
           "these:\n" +
           pipeline::settings_manual([&](Schema& schema) { describe_studies(schema, s); });
}

}  // namespace craze::reproduce
