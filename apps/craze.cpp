// The command line: parse, call, turn exceptions into exit codes.

#include "craze/core/errors.hpp"
#include "craze/core/parallel.hpp"
#include "craze/core/progress.hpp"
#include "craze/core/units.hpp"
#include "craze/core/version.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/pipeline/pipeline.hpp"
#include "craze/reproduce/settings.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <exception>
#include <functional>
#include <new>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
using namespace craze;

enum ExitCode { ok = 0, failed = 1, refused = 2, stopped = 130 };

// Idle threads shall sleep instead of burning a core that someone else may need. The OpenMP library reads its wishes
// when it is loaded, so the program starts itself once more with them set.
void let_idle_threads_sleep(char** argv)
{
    if (std::getenv("OMP_WAIT_POLICY") != nullptr || std::getenv("GOMP_SPINCOUNT") != nullptr) return;
    setenv("GOMP_SPINCOUNT", "20000", 1);  // some microseconds: cheap between two loops, nothing when waiting
    execv("/proc/self/exe", argv);         // returns only when it cannot
}

struct Common {
    std::string settings, out;
    std::vector<std::string> set;
    int threads = 0;
    bool quiet = false;

    void add_to(CLI::App& verb, const std::string& default_out, const std::string& example)
    {
        verb.add_option("--out", out, "folder for the results")->default_str(default_out);
        verb.add_option("--set", set, "override one setting: KEY=VALUE, such as " + example + "; may be repeated")
            ->allow_extra_args(false);
        verb.add_option("--threads", threads, "threads to use; 0 means all cores")->check(CLI::Range(0, 4096));
        verb.add_flag("--quiet", quiet, "print nothing but results and errors");
    }

protected:
    void apply() const
    {
        set_threads(threads);
        set_verbosity(quiet ? Verbosity::quiet : Verbosity::normal);
    }
};

struct Chain : Common {
    void add_to(CLI::App& verb)
    {
        verb.add_option("SETTINGS", settings, "settings file (TOML); 'craze init' writes one")->required();
        Common::add_to(verb, "out/<name of the settings file>", "images.denoise.search=15");
    }

    pipeline::Settings read() const
    {
        apply();
        return pipeline::read({settings, set});
    }

    fs::path folder() const { return out.empty() ? fs::path("out") / fs::path(settings).stem() : fs::path(out); }
};

/// What `reproduce` and `fit-coating` read: a recipe that may be left out.
struct Recipe : Common {
    void add_to(CLI::App& verb)
    {
        verb.add_option("RECIPE", settings,
                        "settings file with [synth], [reproduce], [fit]; the built-in recipe when left out");
        Common::add_to(verb, "out/<verb>", "reproduce.seeds=[1]");
    }

    reproduce::AllSettings read() const
    {
        apply();
        return reproduce::read({settings, set});
    }
};

/// Refuses a first word that is no verb, naming the nearest one.
void check_verb(const CLI::App& app, int argc, char** argv)
{
    if (argc < 2 || argv[1][0] == '-') return;
    std::vector<std::string> verbs;
    for (const auto* verb : app.get_subcommands([](const CLI::App*) { return true; }))
        verbs.push_back(verb->get_name());
    const std::string word = argv[1];
    if (std::ranges::find(verbs, word) != verbs.end()) return;
    const std::string near = nearest_name(word, verbs.data(), verbs.data() + verbs.size());
    throw InvalidInput(
        fmt::format("{}: no such verb; {}", word,
                    near.empty() ? "'craze --help' lists them" : fmt::format("did you mean \"{}\"?", near)));
}

// A packing made elsewhere, named on the command line; each option stands for a key of [domain.import].
struct Import {
    std::vector<std::string> files, box;
    std::string near, unit, format;
    CLI::Option* option = nullptr;

    void add_to(CLI::App& verb)
    {
        option = verb.add_option("--import", files,
                                 "a packing made elsewhere, ELEMENTS [BONDS], taken through loading and report as it "
                                 "is: no images; SETTINGS may be left out")
                     ->expected(1, 2);
        const auto with_import = [&](CLI::Option* other) { other->needs(option); };
        with_import(verb.add_option("--box", box, "its three edges, such as \"17.61 um\"; plain numbers count --unit")
                        ->expected(3));
        with_import(verb.add_option("--unit", unit, "what one of the files' lengths is, such as um; m when left out"));
        with_import(verb.add_option("--near", near, "file of i, j, T of its unbonded near pairs"));
        with_import(verb.add_option("--format", format, "csv, lammps, yade, listing or vtkhdf; told from the files"));
    }

    bool wanted() const { return option->count() > 0; }

    /// The settings that say the same.
    std::vector<std::string> overrides() const
    {
        const auto quoted = [](const std::string& text) {
            std::string out = "\"";
            for (const char c : text) out += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
            return out + '"';
        };
        const std::string one = unit.empty()                                        ? "1 m"
                                : std::isalpha(static_cast<unsigned char>(unit[0])) ? "1 " + unit
                                                                                    : unit;
        std::vector<std::string> set{"domain.import.alone=true", "domain.import.elements=" + quoted(files.front()),
                                     "domain.import.unit=" + quoted(one)};
        if (files.size() > 1) set.push_back("domain.import.bonds=" + quoted(files[1]));
        if (!near.empty()) set.push_back("domain.import.near=" + quoted(near));
        if (!format.empty()) set.push_back("domain.import.format=" + quoted(format));
        if (!box.empty()) {
            const double metres = parse_quantity(one, Dimension::length);
            std::string edges;
            for (const std::string& edge : box) {
                const bool plain = edge.find_first_not_of("0123456789.eE+-") == std::string::npos;
                const double length =
                    plain ? metres * parse_quantity(edge, Dimension::pure) : parse_quantity(edge, Dimension::length);
                edges += fmt::format("{}\"{} m\"", edges.empty() ? "" : ", ", length);
            }
            set.push_back("domain.import.box=[" + edges + "]");
        }
        return set;
    }
};

int run(int argc, char** argv)
{
    CLI::App app(
        "craze: from microscope images of a porous, cracked ceramic to its mechanical behaviour.\n"
        "Exit codes: 0 done, 1 a computation failed, 2 wrong input, 130 interrupted.");
    app.set_version_flag("--version", fmt::format("craze {}", version));
    app.require_subcommand(1);
    std::function<void()> work;

    Chain common;
    bool resume = false, sweep = false;
    auto* run_verb = app.add_subcommand("run", "the whole chain, from images to report");
    common.add_to(*run_verb);
    run_verb->add_flag("--resume", resume, "skip rooms whose input and settings have not changed since they were done");
    run_verb->callback([&] {
        work = [&] {
            fmt::print("{}", pipeline::run(common.read(), {common.settings, common.folder(), common.set, resume}));
        };
    });

    Import import;
    for (const auto& [name, question] : pipeline::rooms()) {
        auto* verb = app.add_subcommand(name, fmt::format("only this room: {}", question));
        common.add_to(*verb);
        if (name == "microstructure")
            verb->add_flag("--sweep", sweep, "also try many R_C and R_E, and propose some (table and pictures)");
        if (name == "domain") {
            import.add_to(*verb);
            verb->get_option("SETTINGS")->required(false);
        }
        verb->callback([&, name = name] {
            work = [&, name] {
                if (name == "domain" && import.wanted()) {
                    const auto set = import.overrides();
                    common.set.insert(common.set.begin(), set.begin(), set.end());
                    if (common.out.empty()) common.out = fs::path("out") / fs::path(import.files.front()).stem();
                    fmt::print("{}",
                               pipeline::run(common.read(), {common.settings, common.folder(), common.set, resume}));
                    return;
                }
                if (common.settings.empty())
                    throw InvalidInput("SETTINGS is required, or a packing: --import ELEMENTS [BONDS]");
                pipeline::run_room(name, common.read(), {common.settings, common.folder(), common.set, false, sweep});
            };
        });
    }

    Recipe recipe;
    std::string size;
    auto* reproduce_verb =
        app.add_subcommand("reproduce", "the paper's numbers beside ours, on coatings of known truth");
    recipe.add_to(*reproduce_verb);
    reproduce_verb->add_option("--size", size, "small: a cube of 8 um; paper: the paper's box, 92 000 elements")
        ->check(CLI::IsMember({"small", "paper"}));
    reproduce_verb->add_flag("--resume", resume, "go on from what an earlier run with the same recipe has finished");
    reproduce_verb->callback([&] {
        work = [&] {
            auto s = recipe.read();
            if (!size.empty()) s.reproduce.size = size == "paper" ? reproduce::Size::paper : reproduce::Size::small;
            const fs::path out = recipe.out.empty() ? fs::path("out/reproduce") : fs::path(recipe.out);
            fmt::print("{}", reproduce::page(reproduce::reproduce(s.synth, s.reproduce, {out, resume})));
        };
    });
    auto* fit_verb = app.add_subcommand(
        "fit-coating",
        "search the cracks of a recipe for the paper's numbers; says what was fitted and what hangs on what");
    recipe.add_to(*fit_verb);
    fit_verb->add_flag("--resume", resume, "take candidates that an earlier run with the same settings has tried");
    fit_verb->callback([&] {
        work = [&] {
            const auto s = recipe.read();
            const fs::path out = recipe.out.empty() ? fs::path("out/fit-coating") : fs::path(recipe.out);
            const auto fit = reproduce::fit_coating(s.synth, s.fit, {out, resume});
            reproduce::save(fit, out);
            fmt::print("{}", reproduce::page(fit));
        };
    });

    std::string file;
    bool force = false;
    auto* init = app.add_subcommand("init", "write a settings file with every key, its default, range and meaning");
    init->add_option("FILE", file, "where to write; standard output when left out");
    init->add_flag("--force", force, "write over a file that is there");
    init->callback([&] {
        work = [&] {
            const std::string text = pipeline::default_settings_text();
            if (file.empty()) {
                fmt::print("{}", text);
                return;
            }
            if (fs::exists(file) && !force)
                throw InvalidInput(fmt::format("{}: is there already; --force writes over it", file));
            io::write_text(file, text);
        };
    });
    auto* manual = app.add_subcommand("settings", "print the manual of all settings (Markdown)");
    manual->callback(
        [&] { work = [] { fmt::print("{}{}", pipeline::settings_reference(), reproduce::settings_reference()); }; });

    check_verb(app, argc, argv);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? ok : refused;
    }
    catch_interrupts();
    work();
    return ok;
}

}  // namespace

int main(int argc, char** argv)
{
    let_idle_threads_sleep(argv);
    try {
        return run(argc, argv);
    } catch (const InvalidInput& error) {
        fmt::print(stderr, "craze: {}\n", error.what());
        return refused;
    } catch (const Interrupted&) {
        fmt::print(stderr, "craze: interrupted; finished rooms are kept, --resume goes on from them\n");
        return stopped;
    } catch (const std::bad_alloc&) {
        fmt::print(stderr,
                   "craze: out of memory; try a smaller crop (images.crop) or fewer elements (domain.mean_radius)\n");
        return failed;
    } catch (const std::exception& error) {
        fmt::print(stderr, "craze: {}\n", error.what());
        return failed;
    }
}
