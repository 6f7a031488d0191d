// haptics_report FOLDER [--quick] [--only TABLE]: measures and writes the tables of the report as CSV files
// into FOLDER.

#include <cstdio>
#include <cstring>
#include <exception>
#include <string_view>

#include "host.hpp"
#include "tables.hpp"

namespace haptics::report {

const char* name_of(Integrator integrator) {
    switch (integrator) {
    case Integrator::semi_implicit:
        return "semi_implicit";
    case Integrator::linearly_implicit:
        return "linearly_implicit";
    case Integrator::exact:
        return "exact";
    }
    return "";
}

void show_progress(const char* what, double share) {
    std::fprintf(stderr, "\r%-32s %3d %%", what, static_cast<int>(100.0 * share));
    if (share >= 1.0)
        std::fputc('\n', stderr);
}

namespace {

int run(const Options& options, std::string_view only) {
    struct Table {
        std::string_view name;
        void (*write)(const Options&);
    };
    constexpr Table k_tables[] = {{"plan", write_plan},
                                  {"error", write_error_vs_runtime},
                                  {"stability", write_stability},
                                  {"experiment1", write_experiment1},
                                  {"experiment2", write_experiment2},
                                  {"extreme", write_extreme},
                                  {"feel", write_feel}};
    if (only == "scene") {
        write_scene(options);
        return 0;
    }
    HostWatch host;
    for (const Table& table : k_tables)
        if (only.empty() || only == table.name)
            table.write(options);
    host.write(options);
    return 0;
}

} // namespace
} // namespace haptics::report

int main(int count, char** arguments) {
    haptics::report::Options options;
    std::string_view only;
    for (int i = 1; i < count; ++i) {
        if (std::strcmp(arguments[i], "--quick") == 0)
            options.quick = true;
        else if (std::strcmp(arguments[i], "--only") == 0 && i + 1 < count)
            only = arguments[++i];
        else
            options.folder = arguments[i];
    }
    if (options.folder.empty()) {
        std::fputs("usage: haptics_report FOLDER [--quick] [--only "
                   "plan|error|stability|experiment1|experiment2|extreme|feel|scene]\n",
                   stderr);
        return 2;
    }
    try {
        std::filesystem::create_directories(options.folder);
        return haptics::report::run(options, only);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "\nhaptics_report: %s\n", error.what());
        return 1;
    }
}
