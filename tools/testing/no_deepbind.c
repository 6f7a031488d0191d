/* Preloaded before a sanitizer: Godot opens libraries with RTLD_DEEPBIND, which would let them go past the sanitizer's own
   malloc and free. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stddef.h>

void* dlopen(const char* file, int flags) {
    static void* (*next)(const char*, int) = NULL;
    if (next == NULL)
        *(void**)&next = dlsym(RTLD_NEXT, "dlopen");
    return next(file, flags & ~RTLD_DEEPBIND);
}
