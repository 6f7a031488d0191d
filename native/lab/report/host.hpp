#pragma once
/// What the figures were measured on, and what else went on meanwhile.

#include <haptics/realtime/host_steal.hpp>

#include "tables.hpp"

namespace haptics::report {

class HostWatch {
  public:
    HostWatch();
    /// host.csv: machine, compiler, flags, date, repeats, time stolen by the host, share of the processor
    /// that this program got.
    void write(const Options& options) const;

  private:
    HostSteal steal_;
    double real_{0.0};
    double own_{0.0};
    bool steal_known_{false};
};

} // namespace haptics::report
