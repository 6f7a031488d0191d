#include <doctest/doctest.h>

#include <limits>

#include "core/pantograph/poses.hpp"

using namespace haptics;
using haptics::testing::all_presets;

TEST_SUITE("pantograph geometry") {
    TEST_CASE("every preset can be built") {
        for (const PantographGeometry& geometry : all_presets()) {
            const std::vector<FigureError> errors = validate(geometry);
            CHECK(errors.empty());
            for (const FigureError& error : errors)
                MESSAGE(error.message());
        }
    }

    TEST_CASE("a bad figure is named with its value, range and remedy") {
        PantographGeometry geometry = ubc_twin_pantograph();
        geometry.bar[1].distal_length[0] = -0.18;
        const std::vector<FigureError> errors = validate(geometry);
        REQUIRE(errors.size() == 1);
        CHECK(errors[0].problem == FigureProblem::out_of_range);
        CHECK(errors[0].field == "bar[1].distal_length[0]");
        CHECK(errors[0].value == -0.18);
        CHECK(errors[0].message() ==
              "bar[1].distal_length[0] is -0.18 m, must lie between 0.005 and 1 m. Give lengths in meters.");
    }

    TEST_CASE("figures that are not numbers, and figures that do not fit together, are told apart") {
        PantographGeometry broken = pantograph_mk2();
        broken.handle_mass = std::numeric_limits<double>::quiet_NaN();
        REQUIRE(validate(broken).size() == 1);
        CHECK(validate(broken)[0].problem == FigureProblem::not_finite);

        PantographGeometry far = pantograph_mk2();
        far.home = Pose(0.5, 0.0, 0.0);
        REQUIRE(validate(far).size() == 1);
        CHECK(validate(far)[0].problem == FigureProblem::inconsistent);
        CHECK(validate(far)[0].field == "home");

        PantographGeometry merged = ubc_twin_pantograph();
        merged.attachment[1] = merged.attachment[0];
        REQUIRE_FALSE(validate(merged).empty());
        CHECK(validate(merged)[0].field == "attachment");

        PantographGeometry bars = pantograph_mk2();
        bars.bar_count = 3;
        REQUIRE(validate(bars).size() == 1);
        CHECK(validate(bars)[0].field == "bar_count");
    }
}
