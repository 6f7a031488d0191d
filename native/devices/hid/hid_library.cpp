#include "hid/hid_library.hpp"

#include <dlfcn.h>
#include <haptics_firmware/protocol.h>

#include <cstdlib>
#include <map>

namespace haptics {

namespace {

// what hidapi gives is ASCII in practice; anything else is shown as '?'
std::string narrow(const wchar_t* text) {
    std::string out;
    for (; text != nullptr && *text != L'\0'; ++text)
        out += *text >= L' ' && *text <= L'~' ? static_cast<char>(*text) : '?';
    return out;
}

} // namespace

std::vector<std::string> HidLibrary::usual_names() {
    if (const char* asked = std::getenv("HAPTICS_HIDAPI"); asked != nullptr && *asked != '\0')
        return {asked};
    return {"libhidapi-hidraw.so.0", "libhidapi-libusb.so.0"};
}

template <class Function>
bool HidLibrary::take(Function& function, const char* name) {
    function = reinterpret_cast<Function>(dlsym(handle_, name));
    return function != nullptr;
}

bool HidLibrary::take_all() {
    return take(init_, "hid_init") && take(enumerate_, "hid_enumerate") &&
           take(free_enumeration_, "hid_free_enumeration") && take(open_path_, "hid_open_path") &&
           take(close_, "hid_close") && take(read_timeout, "hid_read_timeout") && take(write, "hid_write") &&
           take(get_feature_report_, "hid_get_feature_report") &&
           take(send_feature_report_, "hid_send_feature_report") && take(error_, "hid_error") && init_() == 0;
}

std::shared_ptr<HidLibrary> HidLibrary::load(const std::vector<std::string>& names, std::string& error) {
    static std::mutex mutex;
    static std::map<std::string, std::shared_ptr<HidLibrary>> loaded;
    const std::lock_guard lock(mutex);
    std::string tried;
    std::string reason;
    for (const std::string& name : names) {
        if (const auto found = loaded.find(name); found != loaded.end())
            return found->second;
        auto library = std::make_shared<HidLibrary>();
        library->handle_ = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
        if (library->handle_ != nullptr && library->take_all()) {
            loaded[name] = library;
            return library;
        }
        if (reason.empty()) {
            const char* text = dlerror();
            reason = library->handle_ != nullptr ? name + " is no hidapi of version 0.10 or newer"
                                                 : (text != nullptr ? text : "no reason given");
        }
        tried += (tried.empty() ? "" : ", ") + name;
    }
    error = "The library hidapi, which talks to the device, could not be loaded (tried " + tried + ": " +
            reason +
            "). Install it (Debian, Ubuntu: apt install libhidapi-hidraw0; Fedora: dnf install hidapi; Arch: "
            "pacman -S hidapi), or name its file in the environment variable HAPTICS_HIDAPI.";
    return nullptr;
}

std::vector<HidFound> HidLibrary::find(std::uint16_t vendor, std::uint16_t product) {
    const std::lock_guard lock(mutex_);
    std::vector<HidFound> found;
    hid_device_info* const all = enumerate_(vendor, product);
    for (const hid_device_info* d = all; d != nullptr; d = d->next) {
        // not every back end knows the usage
        const bool ours =
            d->usage_page == 0 || (d->usage_page == HAPTICS_USAGE_PAGE && d->usage == HAPTICS_USAGE);
        if (ours && d->path != nullptr)
            found.push_back({d->path, narrow(d->serial_number), narrow(d->product_string)});
    }
    free_enumeration_(all);
    return found;
}

hid_device* HidLibrary::open(const std::string& path, std::string& error) {
    const std::lock_guard lock(mutex_);
    hid_device* const device = open_path_(path.c_str());
    if (device == nullptr)
        error = narrow(error_(nullptr));
    return device;
}

void HidLibrary::close(hid_device* device) {
    const std::lock_guard lock(mutex_);
    close_(device);
}

std::vector<std::uint8_t> HidLibrary::get_feature(hid_device* device, std::uint8_t id, std::size_t size) {
    const std::lock_guard lock(mutex_);
    // a byte of room, so that a report that is too long shows
    std::vector<std::uint8_t> report(size + 1);
    report[0] = id;
    const int got = get_feature_report_(device, report.data(), report.size());
    report.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
    return report;
}

bool HidLibrary::send_feature(hid_device* device, const std::vector<std::uint8_t>& report) {
    const std::lock_guard lock(mutex_);
    return send_feature_report_(device, report.data(), report.size()) == static_cast<int>(report.size());
}

} // namespace haptics
