#pragma once
/// hidapi, opened at run time: a program without it starts and runs, and learns only here that it is missing.

#include <hidapi/hidapi.h>

#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace haptics {

/// A device as hidapi lists it.
struct HidFound {
    std::string path;
    std::string serial;
    std::string product;
};

/// The loaded library. It stays loaded until the process ends: its back ends keep threads and handlers of
/// their own. Any thread, but never the haptic loop.
class HidLibrary {
  public:
    /// File names tried in turn where nothing else is asked for: hidraw first (no driver is taken from the
    /// device, and reports keep their kernel queue), then libusb.
    static std::vector<std::string> usual_names();

    /// The library, loaded by the first of `names` that works. Null, and `error` says what is missing and how
    /// to install it.
    static std::shared_ptr<HidLibrary> load(const std::vector<std::string>& names, std::string& error);

    /// Devices of this vendor and product on our usage page, all serials.
    std::vector<HidFound> find(std::uint16_t vendor, std::uint16_t product);
    /// Opens; null, with the library's own words in `error`, when it cannot.
    hid_device* open(const std::string& path, std::string& error);
    void close(hid_device* device);
    /// Reads feature report `id` of `size` bytes; fewer bytes or none when that fails.
    std::vector<std::uint8_t> get_feature(hid_device* device, std::uint8_t id, std::size_t size);
    /// Writes a feature report.
    bool send_feature(hid_device* device, const std::vector<std::uint8_t>& report);

    /// The two calls of the loop and its writer; each device is used by one thread at a time.
    decltype(&hid_read_timeout) read_timeout{nullptr};
    decltype(&hid_write) write{nullptr};

  private:
    template <class Function>
    bool take(Function& function, const char* name);
    bool take_all();

    void* handle_{nullptr};
    // hidapi keeps its last error in one place for all devices
    std::mutex mutex_;
    decltype(&hid_init) init_{nullptr};
    decltype(&hid_enumerate) enumerate_{nullptr};
    decltype(&hid_free_enumeration) free_enumeration_{nullptr};
    decltype(&hid_open_path) open_path_{nullptr};
    decltype(&hid_close) close_{nullptr};
    decltype(&hid_get_feature_report) get_feature_report_{nullptr};
    decltype(&hid_send_feature_report) send_feature_report_{nullptr};
    decltype(&hid_error) error_{nullptr};
};

} // namespace haptics
