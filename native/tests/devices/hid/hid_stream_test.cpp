// Reports one by one: what is used, and what is counted and left out.
#include <haptics/devices/hid/hid_stream.hpp>

#include <doctest/doctest.h>

#include <support/random.hpp>
#include <vector>

#include "devices/hid/firmware_fixture.hpp"

using namespace haptics;
using namespace haptics::testing;

namespace {

using Report = std::array<std::uint8_t, HAPTICS_INPUT_SIZE>;

constexpr std::int64_t k_ms = 1'000'000;

// a device that makes a report a millisecond, and a host that looks when it is told to
struct Wire {
    explicit Wire(const HidStreamLimits& limits = {})
        : stream(limits) {
        stream.begin(4, {10000.0, 10000.0, 10000.0, 10000.0}, false);
    }
    Report make(int ms = 1) {
        device.now += static_cast<std::uint32_t>(1000 * ms);
        host_ns += k_ms * ms;
        device.measure();
        Report report{};
        haptics_firmware_input(&device.fw, device.now, report.data());
        return report;
    }
    void take(const Report& report) { stream.take(report, host_ns); }
    bool newest() { return stream.newest(host_ns, sample); }
    bool pass() {
        take(make());
        return newest();
    }
    std::uint64_t sum() const {
        const HidCounts& c = stream.counts();
        return c.accepted + c.superseded + c.wrong_size + c.corrupt + c.wrong_version + c.repeated +
               c.out_of_order + c.late + c.jumped + c.no_pose;
    }

    FirmwareFixture device{true, 0xFFFF0000U}; // its clock wraps after 65 ms
    HidStream stream;
    HidSample sample;
    std::int64_t host_ns{123456789};
};

} // namespace

TEST_CASE("reports in order are used one by one, across the wrap of clock and sequence") {
    Wire w;
    w.device.fw.input_sequence = 0xFFFFFFF0;
    for (int n = 0; n < 200; ++n) {
        CHECK(w.pass());
        CHECK(w.stream.interval() == doctest::Approx(n == 0 ? 0.0 : 0.001));
        CHECK(w.stream.age() < 1e-5);
    }
    CHECK(w.stream.counts().accepted == 200);
    CHECK(w.sum() == 200);
    CHECK(w.stream.counts().lost == 0);
    CHECK_FALSE(w.newest());
}

TEST_CASE("of several waiting reports the newest is used") {
    Wire w;
    CHECK(w.pass());
    for (int n = 0; n < 3; ++n)
        w.take(w.make());
    CHECK(w.newest());
    CHECK(w.sample.sequence == 4);
    CHECK(w.stream.interval() == doctest::Approx(0.003));
    CHECK(w.stream.counts().superseded == 2);
    CHECK(w.stream.counts().lost == 0);
}

TEST_CASE(
    "short, long, damaged, repeated and old reports are counted and left out; the next good one is used") {
    Wire w;
    CHECK(w.pass());
    const Report first = w.make();
    w.take(first);
    CHECK(w.newest());

    w.stream.take(std::span(first).first(40), w.host_ns);
    w.stream.take({}, w.host_ns);
    std::array<std::uint8_t, HAPTICS_INPUT_SIZE + 8> longer{};
    w.stream.take(longer, w.host_ns);
    CHECK(w.stream.counts().wrong_size == 3);

    Report damaged = w.make();
    damaged[20] ^= 4U;
    w.take(damaged);
    CHECK(w.stream.counts().corrupt == 1);

    w.take(first);
    CHECK(w.stream.counts().repeated == 1);
    const Report older = w.make();
    const Report newer = w.make();
    w.take(newer);
    w.take(older);
    w.take(first);
    CHECK(w.stream.counts().out_of_order == 2);
    CHECK(w.newest());
    CHECK(w.sample.sequence == 5);
    // the damaged one's number, and the older one's: it came too late to count
    CHECK(w.stream.counts().lost == 2);
    CHECK(w.sum() == 10);
    CHECK(w.pass());
}

TEST_CASE("a report that was held up on its way is left out") {
    Wire w;
    for (int n = 0; n < 50; ++n)
        CHECK(w.pass());
    // the host did not look for 30 ms: what waits is old, but for the newest
    for (int n = 0; n < 30; ++n)
        w.take(w.make());
    CHECK(w.newest());
    CHECK(w.stream.counts().late == 0);
    // 4 ms late is usable, and its age is known; 6 ms is not
    Report report = w.make();
    w.host_ns += 4 * k_ms;
    w.take(report);
    CHECK(w.newest());
    CHECK(w.stream.age() == doctest::Approx(0.004).epsilon(0.05));
    report = w.make();
    w.host_ns += 2 * k_ms;
    w.take(report);
    CHECK_FALSE(w.newest());
    CHECK(w.stream.counts().late == 1);
    w.host_ns -= 6 * k_ms;
    CHECK(w.pass());
    CHECK(w.stream.age() < 1e-4);
}

TEST_CASE("clocks that drift apart by 500 parts in a million make no report late or old") {
    for (const double drift : {5e-4, -5e-4}) {
        Wire w;
        double host = 0.0;
        double oldest = 0.0;
        int used = 0;
        for (int n = 0; n < 120000; ++n) {
            const Report report = w.make();
            host += 1e6 * (1.0 + drift);
            w.host_ns = 1000 + static_cast<std::int64_t>(host);
            w.take(report);
            used += w.newest() ? 1 : 0;
            oldest = std::max(oldest, w.stream.age());
        }
        CAPTURE(drift);
        CHECK(used == 120000);
        CHECK(oldest < 2e-6);
    }
}

TEST_CASE("a way that stays longer is got used to within half a second") {
    Wire w;
    for (int n = 0; n < 300; ++n)
        CHECK(w.pass());
    w.host_ns += 4 * k_ms;
    for (int n = 0; n < 500; ++n)
        CHECK(w.pass());
    CHECK(w.stream.age() < 1e-5);
}

TEST_CASE("an encoder that jumps is found, and positions mean nothing until the device is homed") {
    Wire w;
    for (int n = 0; n < 20; ++n) {
        // 100 rad/s is the limit: 1000 counts a millisecond here
        w.device.board.count[2] += 900;
        CHECK(w.pass());
    }
    w.device.board.count[2] -= 1500;
    CHECK_FALSE(w.pass());
    CHECK(w.stream.counts().jumped == 1);
    CHECK(w.stream.lost_its_place());
    CHECK(w.pass());
    CHECK(w.stream.lost_its_place());
    // homing moves all counts at once, which is no jump
    w.device.fw.homings = 7;
    w.device.fw.zero[2] = 123456;
    CHECK(w.pass());
    CHECK_FALSE(w.stream.lost_its_place());
    CHECK(w.stream.counts().jumped == 1);
    // after a gap a joint may be far away
    w.device.board.count[2] += 5000;
    w.take(w.make(6));
    CHECK(w.newest());
}

TEST_CASE("absolute encoders are believed again after 100 reports without a jump") {
    Wire w;
    w.stream.begin(4, {10000.0, 10000.0, 10000.0, 10000.0}, true);
    CHECK(w.pass());
    w.device.board.count[0] += 5000;
    CHECK_FALSE(w.pass());
    for (int n = 1; n < HidStream::k_quiet; ++n)
        CHECK(w.pass());
    CHECK(w.stream.lost_its_place());
    CHECK(w.pass());
    CHECK_FALSE(w.stream.lost_its_place());
}

TEST_CASE("a counter that wraps is no jump") {
    Wire w;
    w.device.board.count[0] = 2147483600;
    CHECK(w.pass());
    w.device.board.count[0] = -2147483600;
    CHECK(w.pass());
}

TEST_CASE("a connection made anew starts afresh, and its counts go on") {
    Wire w;
    CHECK(w.pass());
    w.device.fw.input_sequence = 0;
    w.device.now = 5;
    w.device.board.count[0] = 777777;
    w.stream.begin(4, {10000.0, 10000.0, 10000.0, 10000.0}, false);
    CHECK(w.pass());
    CHECK(w.stream.interval() == 0.0);
    CHECK(w.stream.counts().accepted == 2);
}

TEST_CASE("any mixture of bad and good reports: sequences only grow, and every report is booked once") {
    Random random(6);
    Wire w;
    std::vector<Report> past;
    std::uint64_t taken = 0;
    std::uint32_t last = 0;
    int wrong = 0;
    for (int n = 0; n < 300000; ++n) {
        for (std::int32_t& count : w.device.board.count)
            count += random.below(401) - 200;
        Report report = w.make(random.below(50) == 0 ? random.below(20) + 1 : 1);
        past.push_back(report);
        if (past.size() > 32)
            past.erase(past.begin());
        for (int copies = random.below(3); copies > 0; --copies) {
            ++taken;
            switch (random.below(5)) {
            case 0: {
                Report bad = report;
                bad[static_cast<std::size_t>(random.below(56))] ^=
                    static_cast<std::uint8_t>(1 + random.below(255));
                w.take(bad);
                break;
            }
            case 1:
                w.stream.take(std::span(report).first(static_cast<std::size_t>(random.below(56))), w.host_ns);
                break;
            case 2:
                w.take(past[static_cast<std::size_t>(random.below(static_cast<int>(past.size())))]);
                break;
            default:
                w.take(report);
            }
        }
        if (random.below(4) != 0 && w.newest()) {
            wrong += w.sample.sequence <= last ? 1 : 0;
            last = w.sample.sequence;
        }
    }
    w.newest();
    CHECK(wrong == 0);
    CHECK(w.sum() == taken);
    CHECK(w.stream.counts().accepted > 50000);
    CHECK(w.stream.counts().repeated > 1000);
    CHECK(w.stream.counts().out_of_order > 1000);
}
