#include <haptics/core/dynamics/multiversion.hpp>

namespace haptics {

#if HAPTICS_MULTIVERSION
const bool k_has_avx2 = __builtin_cpu_supports("avx2") != 0;
#endif

} // namespace haptics
