#include "probe_server.hpp"

// The hot reload test writes this header anew before each build.
#if __has_include(<probe_generation.inc>)
#include <probe_generation.inc>
#else
#define PROBE_GENERATION 0
#endif

namespace haptics {

int64_t ProbeServer::get_generation() const {
    return PROBE_GENERATION;
}

} // namespace haptics
