#pragma once
/// A named thread that leaves signals to others: an interrupted call of hidapi would look like a lost device.

#include <pthread.h>
#include <signal.h>

#include <thread>
#include <utility>

namespace haptics {

template <class Work>
std::thread start_quiet_thread(const char* name, Work&& work) {
    sigset_t all;
    sigset_t before;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before);
    std::thread thread(std::forward<Work>(work));
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    pthread_setname_np(thread.native_handle(), name);
    return thread;
}

} // namespace haptics
