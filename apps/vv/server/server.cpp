// server.cpp: Runs the loop of `vv serve`: passes what pages send to the session of the world, and
// the session's pictures to the pages. Three other threads help: the host's with the connections,
// one that encodes pictures for pages, and one that encodes files (saves.h).
#include "server/server.h"

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>

#include <fmt/format.h>

#include "libpicture/files/formats.h"
#include "options/shader_text.h"
#include "process/messages.h"
#include "process/signals.h"
#include "report/cluster_report.h"
#include "server/address.h"
#include "server/editing.h"
#include "server/host.h"
#include "server/pages.h"
#include "server/reports.h"
#include "server/saves.h"
#include "server/served_world.h"
#include "server/texts.h"
#include "task_threads.h"
#include "xvrml/node_plugin.h"

namespace vv::server {

namespace {

// Seconds. Nothing wakes the loop for a signal: an idle loop looks for one now and then.
constexpr double idleWait = 0.25, quietWait = 0.1, activeWait = 0.004, drawingWait = 0.001;
constexpr double restAfter = 3;                      // seconds without a look
constexpr int movingQuality = 80, stillQuality = 95; // qualities of JPEG
// Seconds from the first SIGINT until the process ends, even if a thread hangs.
constexpr unsigned interruptSeconds = 5;

// A picture of a view that pages get.
struct Shot {
  picture::LivePicture picture;
  uint32_t number = 0;
  int wanted = 0;
  std::string jpeg; // made and used by the encoder's thread
};

class Server {
 public:
  Server(const Options& options, const std::vector<std::string>& arguments)
      : options_(options), arguments_(arguments), hostOptions_(hostOptionsOf(options_.serve)),
        world_(options_, callbacks()) {
    options_.view.shader = readCameraShader(options_);
  }

  int run();

 private:
  double now() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  // --- Waiting ---

  void wake();

  // Waits for an event, the next step, or a picture in flight.
  void wait();

  // Tells whether the session advances. As in the window, a moving picture that is almost finished
  // is waited for, since the next one can then begin at once.
  bool isTime(double time);

  // Frees the pictures when nobody has looked for a while. The world stays in memory.
  void restIfAlone(double time);

  // --- Pages ---

  void takeHostEvents();
  void acknowledge(uint64_t number, uint32_t picture);
  void handle(const HostEvent& event);
  void leave(uint64_t number);
  static InputEvent leaving();
  void endView(uint32_t view);
  void handle(uint64_t number, Page& page, const Message& message);
  void resize(Page& page, PictureSize size);

  // Gives the pictures of each view the size of its page, as far as its share of the pixels allows.
  void fitViews();
  void input(uint64_t number, const Page& page, InputEvent event);

  // --- The world ---

  ServedWorld::Callbacks callbacks();

  // Opens a page of the web for the one who clicked. A Script may want that at any time, and again
  // and again.
  void openPage(const std::string& url);
  void onAction(uint32_t view, Action action);
  void takeWorld();

  // Lets the world run while somebody looks; otherwise its time stands still.
  void advance(double time);

  // --- Pictures ---

  void takePictures();

  // Gives each page that has acknowledged its last picture the newest one of its view.
  void sendPictures();

  // [the encoder's thread]
  void encode(uint64_t page, Shot& shot);
  void sendCommand(uint64_t number, const Page& page);

  // --- Reports ---

  void notify(uint32_t view, const std::string& text, double seconds);
  void tellOfCluster();
  int end();

  using Clock = std::chrono::steady_clock;

  Options options_;
  const std::vector<std::string>& arguments_;
  const HostOptions hostOptions_;
  const Clock::time_point start_ = Clock::now();
  std::mutex mutex_;
  std::condition_variable changed_;
  bool woken_ = false;

  ServedWorld world_;
  Pages pages_;
  std::vector<HostEvent> waiting_; // until the world can be used
  Reports reports_{pages_, world_};
  std::map<uint32_t, std::shared_ptr<Shot>> shots_; // by view: its newest picture
  uint32_t lastShot_ = 0;
  OpenRate openRate_;
  uint64_t clicked_ = 0; // the page whose button went down or up last
  bool watched_ = false; // somebody looks
  bool isQuiet_ = false; // nothing moves, and the pictures are finished
  bool steps_ = false;   // the world has begun to run
  // Seconds: of the world's session, and of this process at its last step and at the next one.
  double time_ = 0, advanced_ = 0, next_ = 0;
  double lastWatched_ = 0;
  bool hasRested_ = false; // the pictures are freed, and nobody has looked since
  uint64_t kept_ = 0;      // Editor::changes() when nobody looked last

  std::unique_ptr<Host> host_;
  std::unique_ptr<Saves> saves_;
  std::unique_ptr<Editing> editing_;
  TaskThreads encoder_; // the last member: its tasks use the others
};

int Server::run() {
  world_.openFirst();
  host_ = std::make_unique<Host>(hostOptions_, [this] { wake(); });
  saves_ = std::make_unique<Saves>(
      options_, pages_, world_, reports_, *host_,
      [this](uint32_t view, const std::string& text) { notify(view, text, 6); });
  editing_ = std::make_unique<Editing>(pages_, world_, *host_, arguments_);
  deferInterrupt(true, interruptSeconds);
  writeOut(urlOf(options_.serve, hostOptions_, host_->port()) + "\n");
  if (const std::string url = editUrlOf(hostOptions_, host_->port()); !url.empty())
    writeOut(url + "  edits the world\n");
  std::fflush(stdout);
  while (!interrupted()) {
    wait();
    takeHostEvents();
    takeWorld();
    const double time = now();
    if (world_.session().resting()) saves_->advance();
    watched_ = pages_.isWatched(time);
    restIfAlone(time);
    if (isTime(time)) advance(time);
    takePictures();
    sendPictures();
    tellOfCluster();
    if (!world_.session().resting()) continue;
    editing_->update(time);
    reports_.tell(time, watched_ && !isQuiet_, *host_);
  }
  return end();
}

void Server::wake() {
  {
    const std::lock_guard lock(mutex_);
    woken_ = true;
  }
  changed_.notify_all();
}

void Server::wait() {
  const Session& session = world_.session();
  const double most = !watched_  ? idleWait
                      : isQuiet_ ? std::min(idleWait, next_ - now())
                      : session.pictures().isDrawing() || session.pictures().isDue() ? drawingWait
                                                                                     : activeWait;
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, std::chrono::duration<double>(std::max(most, 0.001)),
                    [this] { return woken_; });
  woken_ = false;
}

bool Server::isTime(double time) {
  const Session& session = world_.session();
  if (time < next_) return session.pictures().isDue() && time >= advanced_ + activeWait;
  return !session.pictures().isDrawing() || time >= next_ + 1 / options_.fps;
}

void Server::restIfAlone(double time) {
  if (watched_) {
    lastWatched_ = time;
    hasRested_ = false;
  } else if (!hasRested_ && time > lastWatched_ + restAfter) {
    hasRested_ = world_.session().release();
  }
}

void Server::takeHostEvents() {
  for (HostEvent& event : host_->takeEvents()) {
    const bool shown =
        event.kind == HostEvent::Kind::message && event.message.type == Message::Type::shown;
    if (shown)
      acknowledge(event.page, event.message.picture);
    else
      waiting_.push_back(std::move(event));
  }
  if (waiting_.empty() || !world_.session().resting()) return;
  for (const HostEvent& event : std::exchange(waiting_, {})) handle(event);
  isQuiet_ = false;
  next_ = std::min(next_, now());
  reports_.hurry();
}

void Server::acknowledge(uint64_t number, uint32_t picture) {
  Page* const page = pages_.find(number);
  if (page && page->flow.acknowledge(picture)) page->answered = now();
}

void Server::handle(const HostEvent& event) {
  switch (event.kind) {
  case HostEvent::Kind::joined:
    pages_.join(event.page, now());
    host_->sendText(event.page, "", helloText());
    if (event.rights == Rights::edit) editing_->join(event.page);
    break;
  case HostEvent::Kind::left: leave(event.page); break;
  case HostEvent::Kind::message:
    if (Page* const page = pages_.find(event.page)) handle(event.page, *page, event.message);
    break;
  }
}

void Server::leave(uint64_t number) {
  Page* const page = pages_.find(number);
  if (!page) return;
  page->saving = Page::Saving::nothing; // nobody is to be told
  saves_->giveUp(number);
  editing_->leave(number);
  if (page->role == Page::Role::leader)
    world_.session().handle(leaving());
  else if (page->role == Page::Role::own)
    endView(page->view);
  reports_.leave(number);
  pages_.leave(number);
  // Another page may lead now: its own view ends, and the pictures get its size.
  for (uint32_t view = 1; view < maxViews; ++view)
    if (world_.session().viewers().isGuest(view) && pages_.ownerOf(view) == 0) endView(view);
  fitViews();
}

InputEvent Server::leaving() {
  InputEvent event;
  event.kind = InputEvent::Kind::leave;
  return event;
}

void Server::endView(uint32_t view) {
  world_.session().viewers().remove(view);
  shots_.erase(view);
  reports_.endView(view);
}

void Server::handle(uint64_t number, Page& page, const Message& message) {
  switch (message.type) {
  case Message::Type::size: resize(page, pictureSizeFor(message.width, message.height)); break;
  case Message::Type::input: input(number, page, message.input); break;
  case Message::Type::viewpoint:
    if (const auto event = world_.viewpointEvent(message.number)) input(number, page, *event);
    break;
  case Message::Type::own:
    if (const uint32_t view = pages_.separate(number)) {
      world_.session().addGuest(view, page.size.width, page.size.height);
      fitViews();
    } else if (page.role == Page::Role::follower)
      notify(0, fmt::format("there are {} views already", maxViews), 4);
    break;
  case Message::Type::follow: {
    const uint32_t view = page.view;
    if (!pages_.follow(number)) break;
    endView(view);
    fitViews();
    break;
  }
  case Message::Type::save: saves_->want(number, message.format); break;
  case Message::Type::command: sendCommand(number, page); break;
  case Message::Type::edit: editing_->take(number, *message.editCommand); break;
  case Message::Type::shown: break; // acknowledge()
  }
}

void Server::resize(Page& page, PictureSize size) {
  page.size = size;
  page.sized = true;
  fitViews();
}

void Server::fitViews() {
  Session& session = world_.session();
  const auto views = double(pages_.views());
  session.viewers().setMostPreviewPixels(maxPreviewPixels / views);
  for (const auto& [number, page] : pages_.all()) {
    if (!page.sized || page.role == Page::Role::follower) continue;
    const PictureSize size =
        pictureSizeFor(page.size.width, page.size.height, maxViewPixels / views);
    if (page.role == Page::Role::leader)
      session.resize(size.width, size.height);
    else if (SessionViewer* const guest = session.viewers().find(page.view))
      guest->resize(size.width, size.height);
  }
}

void Server::input(uint64_t number, const Page& page, InputEvent event) {
  const bool escapes = event.kind == InputEvent::Kind::down && event.text == "Escape";
  if (page.saving == Page::Saving::picture && escapes) return saves_->giveUp(number);
  if (page.role == Page::Role::follower) return;
  if (event.kind == InputEvent::Kind::press || event.kind == InputEvent::Kind::release)
    clicked_ = number;
  // A click in the editor selects, and works the world's sensors only with Alt.
  event.forView = editing_->isOpen(number) && !event.alt;
  world_.session().handle(event, page.view);
}

ServedWorld::Callbacks Server::callbacks() {
  ServedWorld::Callbacks calls;
  calls.onAction = [this](uint32_t view, const InputEvent&, Action action) {
    onAction(view, action);
  };
  calls.openPage = [this](const std::string& url) { openPage(url); };
  calls.onLeave = [this] {
    if (editing_) editing_->beginAnew();
  };
  calls.onMessage = [this](const std::string& text) { notify(0, text, 10); };
  return calls;
}

void Server::openPage(const std::string& url) {
  if (!openRate_.allow(now()))
    return notify(0, "the world opens too many pages (maxOpensPerMinute)", 10);
  const uint64_t page = pages_.find(clicked_) ? clicked_ : pages_.leader();
  host_->sendText(page, "", openText(url));
}

void Server::onAction(uint32_t view, Action action) {
  const uint64_t number = pages_.ownerOf(view);
  const Page* const page = pages_.find(number);
  if (!page) return;
  Session& session = world_.session();
  using Motion = PictureLoop::Motion;
  switch (action) {
  case Action::save: saves_->want(number, Message::Format::png); break;
  case Action::saveExr: saves_->want(number, Message::Format::exr); break;
  case Action::command: sendCommand(number, *page); break;
  case Action::samples: {
    PictureLoop& pictures = session.viewers().findOrOwn(view).pictures;
    const bool raw = pictures.motion() == Motion::rebuilt;
    pictures.setMotion(raw ? Motion::samples : Motion::rebuilt);
    notify(view, raw ? "raw samples while something moves" : "rebuilt pictures", 3);
    break;
  }
  case Action::reload:
    if (view == 0)
      world_.reload();
    else
      notify(view, "only the page that leads reloads the world", 4);
    break;
  default: break; // the page shows help and facts, and vv ends in the terminal
  }
}

void Server::takeWorld() {
  const Page* const leader = pages_.find(pages_.leader());
  const PictureSize usual{options_.render.width, options_.render.height};
  if (!world_.take(leader && leader->sized ? leader->size : usual)) return;
  for (const auto& [number, page] : pages_.all())
    if (page.role == Page::Role::own)
      world_.session().addGuest(page.view, page.size.width, page.size.height);
  fitViews();
  reports_.beginAnew();
  saves_->loseAll();
  isQuiet_ = false;
}

void Server::advance(double time) {
  const double passed = time - advanced_;
  advanced_ = time;
  next_ = time + 1 / options_.fps;
  if (!watched_) { // the world stands still, and its clock, by which edits are kept
    WorldEditor& editor = world_.session().editor();
    const uint64_t changes = editor.editor().changes();
    if (std::exchange(kept_, changes) != changes) editor.journal().keep();
    return;
  }
  time_ += steps_ ? passed : 0;
  steps_ = true;
  Session& session = world_.session();
  try {
    session.advance(time_);
  } catch (const std::exception& error) { sayError(error.what()); }
  if (!session.resting()) return;
  world_.watch(time);
  isQuiet_ = session.isQuiet();
  if (isQuiet_) next_ = time + quietWait;
}

void Server::takePictures() {
  auto shot = std::make_shared<Shot>();
  uint32_t view = 0;
  while (world_.session().look(shot->picture, view)) {
    shot->number = ++lastShot_;
    shot->wanted = samplesInWindow(options_);
    shots_[view] = std::move(shot);
    shot = std::make_shared<Shot>();
  }
}

void Server::sendPictures() {
  for (auto& [number, page] : pages_.all()) {
    const auto found = shots_.find(page.view);
    if (!page.sized || found == shots_.end()) continue;
    page.flow.offer(found->second->number);
    if (page.flow.take() == 0) continue;
    page.answered = now();
    encoder_.post([this, number = number, shot = found->second] { encode(number, *shot); });
  }
}

void Server::encode(uint64_t page, Shot& shot) {
  const picture::LivePicture& picture = shot.picture;
  const bool still = picture.purpose == picture::LiveFrame::Purpose::still;
  try {
    const bool isFirst = shot.jpeg.empty();
    if (isFirst)
      shot.jpeg = picture::jpegOf(picture.rgb, picture.shownWidth, picture.shownHeight,
                                  still ? stillQuality : movingQuality);
    if (isFirst) shot.picture.rgb = {}; // the JPEG file is all that pages get
    host_->sendPicture(page, pictureMessage(shot.number, picture, shot.wanted, shot.jpeg));
  } catch (const std::exception&) { host_->close(page); } // it would wait for ever
}

void Server::sendCommand(uint64_t number, const Page& page) {
  host_->sendText(number, "", commandText(world_.session().command(arguments_, page.view)));
}

void Server::notify(uint32_t view, const std::string& text, double seconds) {
  reports_.notify(view, text, now() + seconds);
}

void Server::tellOfCluster() {
  if (!options_.render.cluster) return;
  const std::vector<picture::ClusterMessage> notes = options_.render.cluster->takeMessages();
  for (const picture::ClusterMessage& note : notes)
    if (note.level >= 2) notify(0, note.text, 6);
  for (const std::string& line : clusterMessageLines(notes, options_.verbose, options_.quiet))
    say(line);
}

int Server::end() {
  keepEdits(&world_.session());
  world_.end(exitDone);
  interruptHandled();
  return exitDone;
}

} // namespace

} // namespace vv::server

namespace vv {

int runServer(const Options& options, const std::vector<std::string>& arguments) {
  for (const std::string& refused : xvrml::loadNodePlugins(options.nodePath)) sayWarning(refused);
  server::Server server(options, arguments);
  return server.run();
}

} // namespace vv
