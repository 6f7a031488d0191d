#pragma once
/// Tables that the documentation quotes, written by the tests that make them:
///     HAPTICS_TABLES=<folder> haptics_tests -tc=...

#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>

namespace haptics {

/// Hands a stream for the Markdown table `name`.md to `write`, when tables are asked for. Throws
/// std::runtime_error when the file cannot be written.
template <class Write>
void write_doc_table(const char* name, const Write& write) {
    const char* folder = std::getenv("HAPTICS_TABLES");
    if (folder == nullptr)
        return;
    const std::string path = std::string(folder) + "/" + name + ".md";
    std::ofstream out(path);
    write(out);
    out.flush();
    if (!out.good())
        throw std::runtime_error("cannot write " + path);
}

} // namespace haptics
