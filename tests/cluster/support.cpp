#include "cluster/support.h"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstring>
#include <stdexcept>

#include <arpa/inet.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

namespace cluster_test {

Context::Context(const std::string& config) {
  handle = rtNewContext(config.c_str());
  if (!handle) {
    rtGetError();
    throw std::runtime_error(rtGetErrorMessage());
  }
  rtLogCallback(
      [](int level, const char* text, void* user) {
        static_cast<Context*>(user)->log.push_back(std::to_string(level) + " " + text);
      },
      this);
}

Context::~Context() {
  rtMakeCurrent(handle);
  EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
  rtDeleteContext(handle);
}

bool Context::said(const std::string& part) const {
  return std::any_of(log.begin(), log.end(),
                     [&](const std::string& line) { return line.find(part) != line.npos; });
}

World::World() {
  const auto shader = [](const char* name) { return rtNewShader(rtNewShaderClass(name, nullptr)); };
  surface_ = shader("VRML97");
  rtBindShader(surface_);
  color_ = rtParameterHandle("diffuseColor");
  rtParameter3f(color_, .7f, .3f, .2f);

  RTid image = 0;
  rtGenTextures(1, &image);
  rtBindTexture(image);
  std::vector<uint8_t> texels(16 * 16 * 3);
  for (size_t i = 0; i < texels.size(); i++) texels[i] = uint8_t(40 + (i * 37) % 200);
  rtTexImage2D(3, 16, 16, RT_UNSIGNED_BYTE, texels.data());
  const RTid painted = shader("VRML97");
  rtBindShader(painted);
  rtParameterTexture(rtParameterHandle("texture"), image);

  constexpr int n = 40; // a floor with hills
  std::vector<float> points, coordinates;
  std::vector<uint32_t> corners;
  for (int z = 0; z <= n; z++)
    for (int x = 0; x <= n; x++) {
      const float u = float(x) / n, v = float(z) / n;
      points.insert(points.end(),
                    {12 * u - 6, .2f * std::sin(17 * u) * std::cos(13 * v) - 1, 12 * v - 8});
      coordinates.insert(coordinates.end(), {u, v});
      const auto i = uint32_t(z * (n + 1) + x);
      if (x < n && z < n)
        corners.insert(corners.end(), {i, i + n + 1, i + 1, i + 1, i + n + 1, i + n + 2});
    }
  rtVertexPointer(3, RT_FLOAT, 0, points.data());
  rtTexCoordPointer(2, RT_FLOAT, 0, coordinates.data());
  const RTid floor = rtBeginObject(0);
  rtLoadName(1);
  rtDrawElements(RT_TRIANGLES, corners.size(), corners.data(), points.size() / 3);
  rtEndObject();
  rtVertexPointer(3, RT_FLOAT, 0, nullptr);
  rtTexCoordPointer(2, RT_FLOAT, 0, nullptr);
  rtInstantiateObject(floor);

  rtBindShader(surface_);
  ball_ = rtBeginObject(0);
  rtLoadName(2);
  rtSphere(.5f);
  rtEndObject();
  shape_ = rtBeginObject(0);
  rtEndObject();
  for (int i = 0; i < 5; i++) places_.push_back(rtInstantiateObject(ball_));
  places_.push_back(rtInstantiateObject(shape_));

  rtTranslated(2, 5, 4);
  lamp_ = rtUseLight(shader("VRML97PointLight"));
  rtLoadIdentity();
  move(0);
  look({});
}

void World::look(const FrameOptions& look) {
  rtFrameBuffer(look.width, look.height, look.channels);
  rtQuality(RT_SAMPLES_PER_PIXEL, look.samples);
  rtQuality(RT_TRANSPORT, look.transport);
  rtQuality(RT_TILE_SIZE, look.tile);
  rtQuality(RT_PROGRESSIVE, look.progressive);
  rtQualityf(RT_TARGET_ERROR, look.targetError);
}

void World::move(double time) {
  for (size_t i = 0; i < places_.size(); i++) {
    rtLoadIdentity();
    rtTranslated(double(i) - 2.5, .4 * std::sin(time + double(i)), -.5 * double(i % 3));
    rtRotated(40 * time, 0, 1, .2);
    double m[16];
    rtGetMatrixd(m);
    rtInstanceMatrix(places_[i], m);
  }
  rtBindShader(surface_);
  rtParameter3f(color_, .5f + .3f * float(std::sin(time)), .3f, .2f);
  if (int(time * 10) % 7 == 0) { // another shape
    const int sides = 3 + int(time * 10) % 5;
    rtBeginObject(shape_);
    rtLoadName(3);
    rtBegin(RT_TRIANGLE_FAN);
    for (int k = 0; k < sides; k++)
      rtVertex3f(float(std::cos(6.28 * k / sides)), float(std::sin(6.28 * k / sides)),
                 .1f * float(k));
    rtEnd();
    rtEndObject();
  }
  rtLoadIdentity();
  rtLookAt(3 * std::sin(.1 * time), 1.5, 6, 0, 0, 0, 0, 1, 0);
  rtPerspective(45);
  rtLoadIdentity();
}

void World::slow(int depth) { rtQuality(RT_MAX_DEPTH, depth); }

Picture pixels(const FrameOptions& look) {
  const size_t n = size_t(look.width) * size_t(look.height);
  Picture all;
  for (uint32_t channel = 1; channel <= look.channels; channel <<= 1) {
    if (!(look.channels & channel)) continue;
    constexpr uint32_t vectors =
        RT_NORMAL | RT_ALBEDO | RT_POSITION | RT_MOTION | RT_VARIANCE | RT_ERROR;
    const size_t components = channel == RT_RGBA       ? 4
                              : channel == RT_COVERAGE ? 16
                              : channel & vectors      ? 3
                                                       : 1;
    const size_t before = all.size();
    all.resize(before + components * n);
    rtReadPixels(channel, all.data() + before, components * n);
  }
  EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
  return all;
}

Picture expected(const FrameOptions& look, double time) {
  const RTcontext before = rtGetCurrent();
  Picture picture;
  {
    const Context context("threads=1");
    World world;
    world.look(look);
    rtRender();
    // Moving objects are dynamic from then on. Their pixels differ in the last bits from objects
    // that were always there.
    if (time != 0) {
      world.move(time);
      rtRender();
    }
    picture = pixels(look);
  }
  rtMakeCurrent(before);
  return picture;
}

size_t different(const Picture& a, const Picture& b) {
  if (a.size() != b.size()) return std::max(a.size(), b.size());
  size_t count = 0;
  for (size_t i = 0; i < a.size(); i++) count += std::memcmp(&a[i], &b[i], sizeof(float)) != 0;
  return count;
}

RTstats statistics() {
  RTstats stats{};
  stats.size = sizeof stats;
  rtGetStats(&stats);
  return stats;
}

std::vector<RTworker> workers() {
  const RTcontext context = rtGetCurrent();
  std::vector<RTworker> all(rtGetWorkers(context, nullptr, 0));
  if (all.empty()) return all;
  all[0].size = sizeof(RTworker);
  all.resize(std::min(all.size(), rtGetWorkers(context, all.data(), all.size())));
  return all;
}

int freePort() {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  const bool bound = bind(socket, reinterpret_cast<sockaddr*>(&address), size) == 0 &&
                     getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size) == 0;
  close(socket);
  if (!bound) throw std::runtime_error("no free port");
  return ntohs(address.sin_port);
}

Worker::Worker(std::vector<std::string> options, int threads)
    : options_(std::move(options)), threads_(threads), port_(freePort()) {
  start();
}

Worker::~Worker() { kill(); }

void Worker::start() {
  std::vector<std::string> arguments{OPENRT_WORKER, "--threads", std::to_string(threads_)};
  if (std::find(options_.begin(), options_.end(), "--connect") == options_.end())
    arguments.insert(arguments.end(), {"--listen", address()});
  arguments.insert(arguments.end(), options_.begin(), options_.end());
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (!std::getenv("OPENRT_TEST_TALK")) {
    posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
  }
  const int failed = posix_spawn(&pid_, pointers[0], &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) throw std::runtime_error("openrt-worker does not start");
}

void Worker::signal(int number) const {
  if (pid_ > 0) ::kill(pid_, number);
}

void Worker::kill() {
  if (pid_ <= 0) return;
  ::kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
  pid_ = -1;
}

int Worker::wait() {
  int status = 0;
  if (pid_ <= 0 || waitpid(pid_, &status, 0) < 0) return -1;
  pid_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

} // namespace cluster_test
