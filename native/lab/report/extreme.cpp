#include "extreme.hpp"

#include <cstdio>
#include <exception>

#include "csv.hpp"
#include "tables.hpp"

namespace haptics::report {

void write_extreme(const Options& options) {
    std::vector<ExtremeCase> cases;
    add_proxy_cases(cases);
    add_device_cases(cases);
    CsvFile csv(options.folder / "extreme.csv", {"case", "result", "figure", "value", "bound",
                                                 "not_finite_steps", "force_over_limit", "note"});
    int passes = 0;
    int failures = 0;
    for (const ExtremeCase& c : cases) {
        ExtremeResult r;
        try {
            r = c.run();
        } catch (const std::exception& error) {
            r.note = error.what();
        }
        // a value that is not a number passes nothing
        const bool passed = r.value <= c.bound && r.not_finite == 0 && r.force_over_limit <= 1.0 + 1e-9;
        csv.row({c.name, passed ? "pass" : "FAIL", c.figure, r.value, c.bound, static_cast<int>(r.not_finite),
                 r.force_over_limit, r.note});
        ++(passed ? passes : failures);
        if (!passed)
            std::printf("FAIL: %s: %s %g, bound %g%s%s\n", c.name.c_str(), c.figure.c_str(), r.value, c.bound,
                        r.note.empty() ? "" : "; ", r.note.c_str());
        show_progress("extreme cases",
                      static_cast<double>(passes + failures) / static_cast<double>(cases.size()));
    }
    csv.finish();
    std::printf("%d passed, %d failed\n", passes, failures);
}

} // namespace haptics::report
