// Pictures of pages, made by a browser without a display. The browser is the one that shows the interactive pages, so
// that pictures and pages agree.
#pragma once

#include <filesystem>
#include <string>

namespace matstruct::tool {

/// The program named by the environment variable MATSTRUCT_BROWSER, else the first of chromium, chromium-browser and
/// google-chrome in PATH. Throws Error if there is none.
std::filesystem::path find_browser();

/// Writes a PNG of the page, `width` x `height` pixels. `page`: a file, `address`: what follows it in its address (from
/// "#" on). No network, a profile of its own that is removed. Throws Error if the browser fails or takes longer than a
/// minute.
void photograph(const std::filesystem::path& browser, const std::filesystem::path& page, const std::string& address,
                int width, int height, const std::filesystem::path& picture);

}  // namespace matstruct::tool
