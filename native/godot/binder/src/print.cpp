#include <haptics/binder/print.hpp>

#include <vector>

namespace haptics::godot {

void print_error(const std::string& message, std::source_location where) {
    internal::api.print_error(message.c_str(), where.function_name(), where.file_name(),
                              static_cast<int32_t>(where.line()), 0);
}

void print_warning(const std::string& message, std::source_location where) {
    internal::api.print_warning(message.c_str(), where.function_name(), where.file_name(),
                                static_cast<int32_t>(where.line()), 0);
}

void internal::print_array(const Variant* values, int64_t count) {
    constexpr GDExtensionInt k_hash_print = 2648703342;
    static const GDExtensionPtrUtilityFunction print =
        api.variant_get_ptr_utility_function(SNAME("print")._native_ptr(), k_hash_print);
    std::vector<GDExtensionConstTypePtr> pointers;
    for (int64_t i = 0; i < count; ++i) {
        pointers.push_back(values[i]._native_ptr());
    }
    print(nullptr, pointers.data(), static_cast<int32_t>(count));
}

} // namespace haptics::godot
