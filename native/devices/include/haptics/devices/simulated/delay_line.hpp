#pragma once
/// Fixed delays, counted in steps or in seconds.

#include <algorithm>
#include <cstddef>
#include <vector>

namespace haptics {

/// Gives back what was put in `steps` calls ago; `initial` before that. Allocates in its constructor only.
template <typename Value>
class DelayLine {
  public:
    /// `steps` >= 0; 0 hands values straight through.
    DelayLine(std::size_t steps, const Value& initial)
        : values_(steps, initial) {}

    /// Puts `value` in, returns the one that comes out.
    Value push(const Value& value) {
        if (values_.empty())
            return value;
        const Value out = values_[next_];
        values_[next_] = value;
        next_ = next_ + 1 == values_.size() ? 0 : next_ + 1;
        return out;
    }

    /// Makes everything that is under way `value`.
    void fill(const Value& value) { std::fill(values_.begin(), values_.end(), value); }

  private:
    std::vector<Value> values_;
    std::size_t next_{0};
};

/// Gives back the value that was current `delay` seconds ago; a default Value before the first. Allocates in
/// its constructor only.
template <typename Value>
class TimedDelay {
  public:
    /// Values that can be under way at once; the oldest fall out when there are more.
    static constexpr std::size_t k_capacity = 16384;

    /// `delay` s, >= 0.
    explicit TimedDelay(double delay)
        : delay_(delay)
        , ring_(delay > 0.0 ? k_capacity : 1) {}

    /// `value` holds from `time` s on (times must not go back).
    void put(double time, const Value& value) {
        if (delay_ <= 0.0) {
            current_ = value;
            return;
        }
        if (count_ == ring_.size()) {
            first_ = (first_ + 1) % ring_.size();
            --count_;
        }
        ring_[(first_ + count_) % ring_.size()] = {time, value};
        ++count_;
    }

    /// The value at `time` s, to within `tolerance` s.
    const Value& get(double time, double tolerance) {
        while (count_ > 0 && ring_[first_].time + delay_ <= time + tolerance) {
            current_ = ring_[first_].value;
            first_ = (first_ + 1) % ring_.size();
            --count_;
        }
        return current_;
    }

  private:
    struct Entry {
        double time{0.0};
        Value value{};
    };
    double delay_;
    std::vector<Entry> ring_;
    std::size_t first_{0};
    std::size_t count_{0};
    Value current_{};
};

} // namespace haptics
