/* Stands between the real hidapi and the system, for tests: devices that a test program emulates look to
 * hidapi like hidraw devices of the kernel. Loaded with LD_PRELOAD.
 *
 * The environment variable HAPTICS_EMULATED_HID names a folder. Each folder NAME in it is a device that is
 * plugged in: NAME/uevent              HID_ID=…, HID_NAME=…, HID_UNIQ=… as the kernel writes them
 *     NAME/manufacturer, NAME/product, NAME/bcdDevice    attributes of the USB device
 *     NAME/report_descriptor   bytes
 *     NAME/denied              when it is there, opening fails for lack of permission
 *     NAME/reports             SOCK_SEQPACKET socket; one connection for each open file, one packet for each
 * report NAME/features            SOCK_SEQPACKET socket; one connection for each request: 'G' id capacity(2,
 * little-endian) -> report;  'S' report -> one byte What hidapi asks of libudev, of /sys and of /dev/NAME is
 * answered from there; everything else goes to the C library. Packets keep the boundaries of reports, their
 * queue is the ring of the kernel, and an unplug is the end of the connection. */

#define _GNU_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <linux/hidraw.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/un.h>
#include <unistd.h>

#define EXPORT __attribute__((visibility("default")))
#define SYS_PREFIX "/sys/class/hidraw/"
#define DEV_PREFIX "/dev/"
enum { NAME_SIZE = 64, PATH_SIZE = 512, TEXT_SIZE = 1024, FILES = 1024, MOST = 16 };

/* which device an open file belongs to; empty for none */
static char device_of[FILES][NAME_SIZE];
static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;

static const char* registry(void) {
    const char* folder = getenv("HAPTICS_EMULATED_HID");
    return folder != NULL && *folder != '\0' ? folder : NULL;
}

/* the path of a file of a device; false when it does not fit */
static bool path_of(const char* name, const char* file, char path[PATH_SIZE]) {
    const char* folder = registry();
    const int length = folder == NULL ? -1 : snprintf(path, PATH_SIZE, "%s/%s/%s", folder, name, file);
    return length > 0 && length < PATH_SIZE;
}

static bool is_there(const char* name, const char* file) {
    char path[PATH_SIZE];
    struct stat info;
    return path_of(name, file, path) && stat(path, &info) == 0;
}

/* the name of the device that a path belongs to; false for paths of others */
static bool name_in(const char* path, const char* prefix, char name[NAME_SIZE], const char** rest) {
    const size_t skip = strlen(prefix);
    size_t length;
    if (registry() == NULL || path == NULL || strncmp(path, prefix, skip) != 0) {
        return false;
    }
    length = strcspn(path + skip, "/");
    if (length == 0 || length >= NAME_SIZE) {
        return false;
    }
    memcpy(name, path + skip, length);
    name[length] = '\0';
    *rest = path + skip + length;
    return is_there(name, "uevent");
}

/* ---- files ---- */

typedef int (*open_function)(const char*, int, ...);
typedef int (*close_function)(int);
typedef int (*ioctl_function)(int, unsigned long, ...);

/* writes the next definition of a function into a pointer to it: C knows no conversion between the two kinds
 * of pointer */
static void find_next(const char* name, void* function) {
    void* found = dlsym(RTLD_NEXT, name);
    if (found == NULL) {
        fprintf(stderr, "hidraw_preload: the C library has no %s\n", name);
        abort();
    }
    memcpy(function, &found, sizeof found);
}

static int connect_to(const char* name, const char* file) {
    struct sockaddr_un address;
    char path[PATH_SIZE];
    int connection;
    memset(&address, 0, sizeof address);
    address.sun_family = AF_UNIX;
    if (!path_of(name, file, path) || strlen(path) >= sizeof address.sun_path) {
        errno = ENAMETOOLONG;
        return -1;
    }
    memcpy(address.sun_path, path, strlen(path) + 1);
    connection = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
    if (connection >= 0 && connect(connection, (const struct sockaddr*)&address, sizeof address) != 0) {
        const int code = errno;
        close(connection);
        errno = code == ECONNREFUSED ? ENODEV : code;
        return -1;
    }
    return connection;
}

static int open_device(const char* name) {
    int file;
    if (is_there(name, "denied")) {
        errno = EACCES;
        return -1;
    }
    file = connect_to(name, "reports");
    if (file >= 0 && file < FILES) {
        pthread_mutex_lock(&mutex);
        snprintf(device_of[file], NAME_SIZE, "%s", name);
        pthread_mutex_unlock(&mutex);
    }
    return file;
}

static int open_any(const char* function, const char* path, int flags, mode_t mode) {
    char name[NAME_SIZE];
    char real[PATH_SIZE];
    const char* rest;
    open_function next;
    if (name_in(path, DEV_PREFIX, name, &rest) && *rest == '\0') {
        return open_device(name);
    }
    if (name_in(path, SYS_PREFIX, name, &rest) && strncmp(rest, "/device/", 8) == 0 &&
        path_of(name, rest + 8, real)) {
        path = real;
    }
    find_next(function, &next);
    return next(path, flags, mode);
}

#define OPEN_BODY(function)                                                                                  \
    {                                                                                                        \
        mode_t mode = 0;                                                                                     \
        if ((flags & O_CREAT) != 0) {                                                                        \
            va_list more;                                                                                    \
            va_start(more, flags);                                                                           \
            mode = va_arg(more, mode_t);                                                                     \
            va_end(more);                                                                                    \
        }                                                                                                    \
        return open_any(function, path, flags, mode);                                                        \
    }
EXPORT int open(const char* path, int flags, ...) OPEN_BODY("open") EXPORT
    int open64(const char* path, int flags, ...) OPEN_BODY("open64")

        EXPORT int close(int file) {
    close_function next;
    if (file >= 0 && file < FILES && device_of[file][0] != '\0') {
        pthread_mutex_lock(&mutex);
        device_of[file][0] = '\0';
        pthread_mutex_unlock(&mutex);
    }
    find_next("close", &next);
    return next(file);
}

/* ---- feature reports ---- */

static int get_feature(const char* name, uint8_t* report, size_t capacity) {
    const uint8_t request[4] = {'G', report[0], (uint8_t)(capacity & 0xFFu),
                                (uint8_t)((capacity >> 8u) & 0xFFu)};
    const int connection = connect_to(name, "features");
    ssize_t got = -1;
    if (connection < 0) {
        return -1;
    }
    if (send(connection, request, sizeof request, MSG_NOSIGNAL) == (ssize_t)sizeof request) {
        got = recv(connection, report, capacity, 0);
    }
    close(connection);
    if (got <= 0) {
        errno = EPIPE;
        return -1;
    }
    return (int)got;
}

static int set_feature(const char* name, const uint8_t* report, size_t size) {
    uint8_t request[TEXT_SIZE];
    uint8_t answer = 0;
    const int connection = size < sizeof request ? connect_to(name, "features") : -1;
    bool done = false;
    if (connection < 0) {
        return -1;
    }
    request[0] = 'S';
    memcpy(request + 1, report, size);
    if (send(connection, request, size + 1, MSG_NOSIGNAL) == (ssize_t)(size + 1)) {
        done = recv(connection, &answer, 1, 0) == 1;
    }
    close(connection);
    if (!done) {
        errno = EPIPE;
        return -1;
    }
    return (int)size;
}

static ssize_t read_file(const char* name, const char* file, void* bytes, size_t capacity) {
    char path[PATH_SIZE];
    FILE* from = path_of(name, file, path) ? fopen(path, "re") : NULL;
    size_t got;
    if (from == NULL) {
        return -1;
    }
    got = fread(bytes, 1, capacity, from);
    fclose(from);
    return (ssize_t)got;
}

static int device_ioctl(const char* name, unsigned long request, void* argument) {
    const size_t size = _IOC_SIZE(request);
    if (_IOC_TYPE(request) != 'H') {
        errno = EINVAL;
        return -1;
    }
    switch (_IOC_NR(request)) {
    case 0x01:   /* size of the report descriptor */
    case 0x02: { /* the descriptor */
        struct hidraw_report_descriptor descriptor;
        const ssize_t got = read_file(name, "report_descriptor", descriptor.value, sizeof descriptor.value);
        if (got < 0) {
            errno = ENODEV;
            return -1;
        }
        if (_IOC_NR(request) == 0x01) {
            *(int*)argument = (int)got;
            return 0;
        }
        memcpy(((struct hidraw_report_descriptor*)argument)->value, descriptor.value, (size_t)got);
        return 0;
    }
    case 0x06:
        return set_feature(name, argument, size);
    case 0x07:
        return get_feature(name, argument, size);
    default:
        errno = EINVAL;
        return -1;
    }
}

EXPORT int ioctl(int file, unsigned long request, ...) {
    char name[NAME_SIZE] = "";
    void* argument;
    ioctl_function next;
    va_list more;
    va_start(more, request);
    argument = va_arg(more, void*);
    va_end(more);
    if (file >= 0 && file < FILES && device_of[file][0] != '\0') {
        pthread_mutex_lock(&mutex);
        memcpy(name, device_of[file], NAME_SIZE);
        pthread_mutex_unlock(&mutex);
    }
    if (name[0] != '\0') {
        return device_ioctl(name, request, argument);
    }
    find_next("ioctl", &next);
    return next(file, request, argument);
}

/* ---- libudev: the dozen functions that hidapi calls; their prototypes are in its header, which is not
 * needed here ---- */

#pragma GCC diagnostic ignored "-Wmissing-prototypes"

struct udev {
    int unused;
};
struct udev_list_entry {
    char path[PATH_SIZE];
    struct udev_list_entry* next;
};
struct udev_enumerate {
    struct udev_list_entry entry[MOST];
    int count;
};
/* a device and its parents are one: they are told apart only by the attributes asked for */
struct udev_device {
    char name[NAME_SIZE];
    char sys[PATH_SIZE];
    char dev[PATH_SIZE];
    char text[8][TEXT_SIZE];
    int texts;
};

static struct udev the_udev;

EXPORT struct udev* udev_new(void) {
    return &the_udev;
}
EXPORT struct udev* udev_unref(struct udev* udev) {
    (void)udev;
    return NULL;
}
EXPORT struct udev_enumerate* udev_enumerate_new(struct udev* udev) {
    (void)udev;
    return calloc(1, sizeof(struct udev_enumerate));
}
EXPORT struct udev_enumerate* udev_enumerate_unref(struct udev_enumerate* list) {
    free(list);
    return NULL;
}
EXPORT int udev_enumerate_add_match_subsystem(struct udev_enumerate* list, const char* subsystem) {
    (void)list;
    (void)subsystem;
    return 0;
}
EXPORT int udev_enumerate_scan_devices(struct udev_enumerate* list) {
    struct dirent** found = NULL;
    const int count = registry() == NULL ? 0 : scandir(registry(), &found, NULL, alphasort);
    int i;
    for (i = 0; i < count; ++i) {
        if (list->count < MOST && strlen(found[i]->d_name) < NAME_SIZE &&
            is_there(found[i]->d_name, "uevent")) {
            struct udev_list_entry* entry = &list->entry[list->count++];
            snprintf(entry->path, PATH_SIZE, SYS_PREFIX "%s", found[i]->d_name);
            if (list->count > 1) {
                list->entry[list->count - 2].next = entry;
            }
        }
        free(found[i]);
    }
    free(found);
    return 0;
}
EXPORT struct udev_list_entry* udev_enumerate_get_list_entry(struct udev_enumerate* list) {
    return list->count > 0 ? &list->entry[0] : NULL;
}
EXPORT struct udev_list_entry* udev_list_entry_get_next(struct udev_list_entry* entry) {
    return entry->next;
}
EXPORT const char* udev_list_entry_get_name(struct udev_list_entry* entry) {
    return entry->path;
}
EXPORT struct udev_device* udev_device_new_from_syspath(struct udev* udev, const char* path) {
    char name[NAME_SIZE];
    const char* rest;
    struct udev_device* device;
    (void)udev;
    if (!name_in(path, SYS_PREFIX, name, &rest)) {
        return NULL;
    }
    device = calloc(1, sizeof *device);
    if (device != NULL) {
        memcpy(device->name, name, NAME_SIZE);
        snprintf(device->sys, PATH_SIZE, SYS_PREFIX "%s", name);
        snprintf(device->dev, PATH_SIZE, DEV_PREFIX "%s", name);
    }
    return device;
}
EXPORT struct udev_device* udev_device_new_from_devnum(struct udev* udev, char type, dev_t number) {
    (void)udev;
    (void)type;
    (void)number;
    return NULL;
}
EXPORT struct udev_device* udev_device_unref(struct udev_device* device) {
    free(device);
    return NULL;
}
EXPORT const char* udev_device_get_syspath(struct udev_device* device) {
    return device->sys;
}
EXPORT const char* udev_device_get_devnode(struct udev_device* device) {
    return device->dev;
}
EXPORT struct udev_device* udev_device_get_parent_with_subsystem_devtype(struct udev_device* device,
                                                                         const char* subsystem,
                                                                         const char* type) {
    (void)subsystem;
    (void)type;
    return device;
}
EXPORT const char* udev_device_get_sysattr_value(struct udev_device* device, const char* attribute) {
    char* text;
    ssize_t got;
    if (device->texts >= 8) {
        return NULL;
    }
    text = device->text[device->texts];
    got = read_file(device->name, attribute, text, TEXT_SIZE - 1);
    if (got < 0) {
        return NULL;
    }
    text[got] = '\0';
    ++device->texts;
    return text;
}
