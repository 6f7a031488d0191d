#pragma once
/// Judges input reports one by one: what is short, damaged, repeated, out of order, late or absurd is counted
/// and left out.

#include <haptics/devices/hid/hid_codec.hpp>

#include <array>
#include <cstdint>
#include <span>

namespace haptics {

/// Reports since the device was opened. They only grow; each report adds to exactly one of the first ten.
struct HidCounts {
    /// Handed to the loop.
    std::uint64_t accepted{0};
    /// Good, but a newer one came before the loop looked.
    std::uint64_t superseded{0};
    /// Of the wrong size.
    std::uint64_t wrong_size{0};
    /// With a wrong checksum or id.
    std::uint64_t corrupt{0};
    /// Of another protocol version.
    std::uint64_t wrong_version{0};
    /// The same sequence number again.
    std::uint64_t repeated{0};
    /// Older than one that came before.
    std::uint64_t out_of_order{0};
    /// On its way for longer than HidStreamLimits::late.
    std::uint64_t late{0};
    /// An encoder moved faster than a joint can.
    std::uint64_t jumped{0};
    /// Counts that belong to no pose of the handle.
    std::uint64_t no_pose{0};
    /// Sequence numbers that never came. Those of damaged reports count here too: nobody can read them.
    std::uint64_t lost{0};
};

/// What a stream holds reports to.
struct HidStreamLimits {
    /// Most time that a report may be on its way beyond the shortest seen, s, 1e-3 to 1.
    double late{0.005};
    /// Fastest joint, rad/s, 1 to 1e4.
    double max_joint_speed{100.0};
};

/// One connection's reports. Loop thread only; neither allocates nor throws.
class HidStream {
  public:
    explicit HidStream(const HidStreamLimits& limits = {})
        : limits_(limits) {}

    /// A new connection of `axes` encoders with so many counts per rad of their joints. `absolute`: they know
    /// their place again by themselves after a jump. Counts go on.
    void begin(std::size_t axes, const std::array<double, k_hid_axes>& counts_per_radian, bool absolute);
    /// One report as it came, at `now_ns` of the host's clock.
    void take(std::span<const std::uint8_t> bytes, std::int64_t now_ns);
    /// The newest good report among those taken since the last call; false when there is none.
    bool newest(std::int64_t now_ns, HidSample& sample);

    /// Time between the last two reports that newest() gave, on the device's clock, s; 0 after begin().
    [[nodiscard]] double interval() const { return interval_; }
    /// How much longer than the quickest the last report given was on its way or waited, s.
    [[nodiscard]] double age() const { return age_; }
    /// An encoder jumped since begin(): positions mean nothing until the device is homed, or, with absolute
    /// encoders, until k_quiet reports came without a jump.
    [[nodiscard]] bool lost_its_place() const { return lost_its_place_; }
    [[nodiscard]] const HidCounts& counts() const { return counts_; }
    /// Books a report that newest() gave and that belongs to no pose.
    void note_no_pose() {
        --counts_.accepted;
        ++counts_.no_pose;
    }

    /// Reports without a jump after which absolute encoders are believed again.
    static constexpr int k_quiet = 100;

  private:
    [[nodiscard]] bool jumps(const HidSample& sample, double seconds) const;

    HidStreamLimits limits_;
    HidCounts counts_;
    std::size_t axes_{0};
    std::array<double, k_hid_axes> counts_per_radian_{};
    // last good report
    bool has_last_{false};
    HidSample last_;
    std::int64_t device_ns_{0};
    std::int64_t shortest_ns_{0};
    std::int64_t least_age_ns_{0};
    int in_period_{0};
    bool pending_{false};
    // last report given
    bool has_given_{false};
    HidSample given_;
    std::int64_t given_ns_{0};
    double interval_{0.0};
    double age_{0.0};
    bool lost_its_place_{false};
    bool absolute_{false};
    int quiet_{0};
};

} // namespace haptics
