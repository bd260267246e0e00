// What lies on the table while the window is open: the document, the settings with their past, the camera
// with its bookmarks, the viewer; and what keys and hands do to them. Depends on all of preview and volume.
#pragma once

#include <optional>

#include "preview/app/app.h"
#include "preview/app/bookmarks.h"
#include "preview/app/document.h"
#include "preview/app/frame_pace.h"
#include "preview/app/history.h"
#include "preview/app/live_session.h"
#include "preview/app/orbit_camera.h"
#include "preview/app/ui_state.h"
#include "preview/app/viewer.h"
#include "preview/app/window.h"
#include "preview/measure/scene_facts.h"

namespace nephele {

/// The scene and volume that the command line names, read before there is a window.
struct FirstVolume {
  Scene scene;
  VolumeKey key;
  std::optional<FileStamp> stamp;
  std::shared_ptr<const BrickVolume> volume;
};

/// Throws InputError where they cannot be read.
FirstVolume openFirst(const RenderOptions& options);

/// Used from the window's thread, with its context current.
class Desk {
 public:
  Desk(const AppOptions& options, const FirstVolume& first, Window& window, ReadAhead& reader);

  /// Draws a first coarse picture and chooses the exposure from it.
  void begin();
  void takeHands(const Hands& hands);
  /// `before`: the settings before the panel was drawn. `held`: a widget is, and its changes are one step.
  void takeWishes(const UiWishes& wishes, const Settings& before, bool held);
  void lookAtFiles();
  /// Lets files, frames and flight come on. Returns whether anything was changed that should be seen.
  bool advance(double seconds);
  /// As Viewer::work; what cannot be drawn becomes a notice.
  bool work(double seconds);
  /// Puts the picture into the window's framebuffer.
  void show(int width, int height);
  /// Seconds until something is due by itself; nullopt: nothing is.
  std::optional<double> due() const;

  UiState& state() { return state_; }
  UiFacts facts() const;
  /// What so many presses did is on the screen.
  void noteShown(uint64_t presses);
  /// To the file of --stats, where one is asked for: when a file is shown, when a picture begins anew, when
  /// its noise is first known, when what hands did is shown, while particles play live, and at the end.
  void writeStats() const;

 private:
  void act(Action action);
  /// Closes what is open, the window last.
  void quit();
  void otherLook();
  /// So many rows on in the table of views, round.
  void turnViews(int by);
  void actOnCamera(Action action);
  void actOnFiles(Action action);
  void takeKey(const KeyPress& press);
  void turnSun(const Drag& drag);
  void focus(const std::optional<Place>& place);
  void fly(double seconds);
  void takeDrop(const std::string& path);
  void takeNews(const DocumentNews& news);
  /// Camera, medium and title for the volume that is shown now.
  void adopt(bool otherFile);
  void adoptScene(const std::string& path);
  void adoptEnvironment(const std::string& path);
  /// Chooses the exposure for a file opened later, unless the command line says it.
  void exposeOther();
  void undoOrRedo(bool undo);
  void split();
  void swapSides();
  void saveTheScene();
  void picture(const std::string& extension);
  void actOnParticles(Action action);
  void beginLive();
  void endLive();
  /// Takes parameters and voxels over to live particles and their volume to the viewer. Where they cannot be,
  /// says so.
  void followLive();
  bool advanceLive(double seconds);
  void bakeThis();
  /// Looks at all of it, and at the stage.
  Camera framed(const BrickVolume& volume, double fov) const;
  /// `move`: of the camera, which undo takes back with the change.
  void change(const Settings& before, std::optional<CameraMove> move = {});
  /// Frames anew where the stage, which has just changed, would be seen from beneath its floor.
  std::optional<CameraMove> riseAboveFloor();
  void restart();
  LaneRequest request(const Settings& settings) const;
  std::array<Shown, kSideCount> shown() const;
  Screen screen(int width, int height) const;
  void say(const std::string& notice);
  double aspect() const;

  const AppOptions& options_;
  Window& window_;
  Scene firstScene_;                // as the command line gave it, for files opened later
  std::optional<int> fittedCount_;  // of octaves, where the scene left it open and the file gave it
  Document document_;
  BrickFacts brickFacts_;  // of the file's volume
  Viewer viewer_;
  UiState state_;
  std::optional<LiveSource> liveSource_;  // of the file
  std::optional<LiveSession> live_;       // goes before the viewer
  History<Settings> history_;
  Bookmarks bookmarks_;
  Camera firstCamera_;
  OrbitCamera orbit_;
  double flySpeed_ = 1.0;  // of the distance to the target, a second
  double noticeSeconds_ = 0.0;
  FramePace pace_;             // of coarse pictures
  uint64_t shownRestart_ = 0;  // the last that a coarse picture was shown of
  int width_ = 0, height_ = 0;
  uint64_t restarts_ = 0;
  bool statsKnown_ = false;  // for the picture that is being drawn
  uint64_t pressesShown_ = 0;
};

}  // namespace nephele
