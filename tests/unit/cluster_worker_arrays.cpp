// cluster_worker_arrays.cpp: Tests where a worker's session takes arrays from: the folder, other
// workers, the master.
#include "unit/cluster_worker_rig.h"

using namespace openrt;
using namespace openrt::cluster;

TEST(Worker, whatTheFolderHasIsNotSentAgain) {
  const Folder place;
  ArrayFolder folder(place / "arrays", 1 << 20, {});
  const auto serve = [&] {
    Rig rig(nullptr, 0, &folder);
    rig.greet();
    rig.tell(LargeScene(1).message);
    return rig.answer<message::Need>().arrays.size();
  };
  EXPECT_EQ(serve(), 1u);
  {
    Rig rig(nullptr, 0, &folder);
    rig.greet();
    const LargeScene scene(1);
    rig.tell(scene.message);
    rig.said.clear();
    rig.tell(scene.piece());
    const auto got = rig.answer<message::Got>();
    EXPECT_EQ(got.arrays, std::vector<Hash>{scene.hash()});
    EXPECT_TRUE(got.kept && !got.failed);
    EXPECT_EQ(rig.machine.all(), std::vector<std::string>{"scene 1 whole prepare"});
  }
  EXPECT_EQ(serve(), 0u) << "a worker that begins later";
}

TEST(Worker, arraysComeFromOtherWorkers) {
  const Folder place, elsewhere;
  ArrayFolder folder(place / "arrays", 1 << 20, {});
  Rig rig(nullptr, 1 << 20, &folder);
  rig.greet();
  const LargeScene scene(1);
  const message::ArrayName name = scene.message.arrays[0];
  rig.tell(scene.message);
  rig.said.clear();
  rig.tell(message::Source{.address = "node:1", .arrays = {name}});
  ASSERT_EQ(rig.asked.size(), 1u);
  EXPECT_EQ(rig.asked[0].first, "node:1");
  rig.worker.fetched(name.hash, nullptr); // the node has gone
  EXPECT_TRUE(rig.answer<message::Got>().failed);
  EXPECT_TRUE(rig.machine.all().empty());
  rig.worker.fetched(name.hash, scene.texels);
  EXPECT_FALSE(rig.answer<message::Got>().failed);
  EXPECT_EQ(rig.machine.all(), std::vector<std::string>{"scene 1 whole prepare"});
  rig.tell(scene.piece()); // the master was about to send it
  rig.tell(message::Source{.address = "node:1", .arrays = {name}});
  rig.worker.fetched(name.hash, scene.texels);
  EXPECT_TRUE(rig.badOnes.empty());
  EXPECT_TRUE(rig.said.empty());
  EXPECT_EQ(rig.counts.sentByWorkers.bytes, name.bytes);
}

TEST(Worker, anotherWorkerMayHaveFilledTheFolder) {
  const Folder place;
  ArrayFolder folder(place / "arrays", 1 << 20, {});
  Rig rig(nullptr, 1 << 20, &folder), other(nullptr, 1 << 20, &folder);
  const LargeScene scene(1);
  for (Rig* one : {&rig, &other}) {
    one->greet();
    one->tell(scene.message);
    one->said.clear();
  }
  rig.tell(scene.piece());
  other.tell(message::Source{.address = "node:1", .arrays = {scene.message.arrays[0]}});
  EXPECT_TRUE(other.asked.empty());
  EXPECT_TRUE(other.answer<message::Got>().kept);
  EXPECT_EQ(other.machine.all(), std::vector<std::string>{"scene 1 whole prepare"});
  EXPECT_EQ(other.counts.inFolder.number, 1u);
}

TEST(Worker, sourcesOfNonsenseAreRefused) {
  const Folder place;
  ArrayFolder folder(place / "arrays", 1 << 20, {});
  Rig rig(nullptr, 1 << 20, &folder);
  rig.greet();
  const LargeScene scene(1);
  rig.tell(scene.message);
  rig.said.clear();
  message::ArrayName name = scene.message.arrays[0];
  rig.tell(message::Source{.address = "node:1", .arrays = {{0, 5, {1, 2}}}}); // not needed
  EXPECT_TRUE(rig.asked.empty() && rig.badOnes.empty());
  name.bytes++;
  rig.tell(message::Source{.address = "node:1", .arrays = {name}});
  EXPECT_EQ(rig.badOnes.size(), 1u);
}
