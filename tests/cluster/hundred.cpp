// hundred.cpp: a hundred worker processes on one machine. They pass a large array on to each other,
// so that the master sends it few times, and the picture has the same bytes as with one thread.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <random>

#include <unistd.h>

#include "cluster/support.h"

namespace {

using namespace cluster_test;
namespace fs = std::filesystem;

constexpr size_t processes = 100, corners = 90000;
constexpr size_t arrayBytes = corners * 3 * sizeof(float);

// A folder that the destructor removes.
struct Folder {
  std::string path;
  Folder() {
    std::string name = (fs::temp_directory_path() / "openrt-hundred-XXXXXX").string();
    path = mkdtemp(name.data());
  }
  ~Folder() { fs::remove_all(path); }
};

// A cloud of small triangles, whose corners do not become fewer bytes by packing.
void addCloud() {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> place(-3, 3), offset(-.05f, .05f);
  std::vector<float> points;
  for (size_t i = 0; i < corners; i += 3) {
    const float at[] = {place(random), place(random), place(random)};
    for (int corner = 0; corner < 3; corner++)
      for (const float coordinate : at) points.push_back(coordinate + offset(random));
  }
  rtVertexPointer(3, RT_FLOAT, 0, points.data());
  const RTid cloud = rtBeginObject(0);
  rtDrawArrays(RT_TRIANGLES, 0, corners);
  rtEndObject();
  rtVertexPointer(3, RT_FLOAT, 0, nullptr);
  rtInstantiateObject(cloud);
}

Picture picture(const FrameOptions& look) {
  World world;
  addCloud();
  world.look(look);
  rtRender();
  return pixels(look);
}

bool holdsTheArray(const fs::path& folder) {
  std::error_code error; // files come and go
  for (const auto& file : fs::directory_iterator(folder, error))
    if (file.path().extension() == ".zst" && file.file_size(error) > arrayBytes / 2) return true;
  return false;
}

TEST(ClusterProcesses, AHundredWorkersPassAnArrayOn) {
  const FrameOptions look{.width = 32, .height = 24, .samples = 2};
  Picture alone;
  {
    const Context context("threads=1");
    alone = picture(look);
  }
  const Folder folder;
  const std::string master = "127.0.0.1:" + std::to_string(freePort());
  const Context context("backend=cluster threads=1 listen=" + master);
  std::vector<std::unique_ptr<Worker>> helping;
  for (size_t i = 0; i < processes; i++)
    helping.push_back(std::make_unique<Worker>(std::vector<std::string>{
        "--connect", master, "--share", "--cache-folder", folder.path + "/" + std::to_string(i)}));
  ASSERT_TRUE(until([] { return statistics().cluster.workers >= processes; }, 120))
      << statistics().cluster.workers << " workers";
  EXPECT_EQ(different(picture(look), alone), 0u);
  size_t holders = 0;
  const auto haveAll = [&] {
    holders = 0;
    for (size_t i = 0; i < processes; i++)
      holders += holdsTheArray(fs::path(folder.path) / std::to_string(i));
    return holders == processes;
  };
  EXPECT_TRUE(until(haveAll, 120)) << holders << " workers have the array";
  // It is sent once, and again where a busy machine makes a worker late: far from a hundred times.
  const uint64_t sent = statistics().cluster.bytesSent;
  EXPECT_GE(sent, arrayBytes / 2);
  EXPECT_LT(sent, processes / 3 * arrayBytes);
  RecordProperty("bytesSent", std::to_string(sent));
  std::printf("the master has sent %.1f times the array\n", double(sent) / double(arrayBytes));
}

} // namespace
