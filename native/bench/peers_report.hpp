#pragma once
/// What the laboratory report says of other engines beyond the time of a step: which error costs how much,
/// and how well a peg in a hole and a wall are kept.

#include <string>

namespace haptics::bench {

/// Writes peers_precision.csv and peers_contact.csv into `folder`; quick: fewer steps are tried at most.
/// Throws std::runtime_error when it cannot.
void write_peer_tables(const std::string& folder, bool quick);

} // namespace haptics::bench
