// The window: opens it, runs it until it is closed. Depends on all of preview and volume.
#pragma once

#include <string>

#include "preview/render_command.h"

namespace nephele {

/// `render` says what is shown and how; its size, samples and output do not count here. Its stats are written
/// when a file is shown, when a picture's noise is first known, and at the end.
struct AppOptions {
  RenderOptions render;
  int width = 1280;
  int height = 720;
  std::string folder;  // where pictures (nephele_0001.png and on) and scenes go
};

/// Shows the file until the window is closed. Returns the exit code 0. Throws InputError for the file or
/// scene, WorldError where there is no display or no OpenGL 4.5.
int runApp(const AppOptions& options);

}  // namespace nephele
