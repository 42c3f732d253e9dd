// A finished folder put where an older one stands.
#pragma once

#include <filesystem>

namespace lumitexel {

// `fresh` takes the place of `target`, in the same file system; what stood there, if anything, is removed. Where the system can exchange two
// folders in one step, whoever is killed meanwhile leaves the old one whole or the new one; elsewhere (network and user-space file systems) the
// old one lies as ".NAME.replaced" beside it for a moment. Throws Error, `target` then being as it was.
void replace_directory(const std::filesystem::path& fresh, const std::filesystem::path& target);

}  // namespace lumitexel
