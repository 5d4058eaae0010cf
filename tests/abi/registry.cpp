// registry.cpp: which shader libraries the registry finds, loads and refuses. The libraries come
// from tests/abi/plugins.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "plugin_files.h"
#include "shading/plugin_check.h"
#include "shading/registry.h"

namespace {

using namespace openrt;
namespace fs = std::filesystem;

const std::string plugins = OPENRT_TEST_PLUGINS;

std::string refusal(const ShaderRegistry& registry, const std::string& name,
                    const std::string& library) {
  try {
    registry.find(name, library);
  } catch (const std::runtime_error& e) { return e.what(); }
  return {};
}

struct Refused {
  const char* library;
  const char* reason;
};

class RefusedPlugin : public testing::TestWithParam<Refused> {};

TEST_P(RefusedPlugin, SaysWhy) {
  const ShaderRegistry registry({plugins});
  const std::string text = refusal(registry, "Example", GetParam().library);
  EXPECT_NE(text.find(GetParam().reason), text.npos) << text;
  EXPECT_NE(text.find(GetParam().library), text.npos) << text;
}

INSTANTIATE_TEST_SUITE_P(
    Abi, RefusedPlugin,
    testing::Values(
        Refused{"missing_symbol", "exports no rtsPlugin"}, Refused{"small_symbol", "has 4 bytes"},
        Refused{"wrong_magic", "wrong magic number"},
        Refused{"other_major", "made for shader ABI 2.3; this library has 1.3"},
        Refused{"newer_minor", "made for shader ABI 1.4; this library has 1.3"},
        Refused{"plugin_size", "claims a plug-in structure of"},
        Refused{"no_classes", "claims 0 shader classes"},
        Refused{"many_classes", "claims 4294967295 shader classes"},
        Refused{"class_table", "claims 1 shader classes"}, Refused{"class_empty", "an empty entry"},
        Refused{"class_twice", "two classes called Example"},
        Refused{"class_kind", "unknown kind 7"}, Refused{"class_unnamed", "a class without a name"},
        Refused{"class_too_small", "claims a class structure of"},
        Refused{"class_too_large", "claims a class structure of"},
        Refused{"class_without_shade", "lacks the function shade"},
        Refused{"parameter_count", "claims 1000000 parameters"},
        Refused{"parameter_table", "claims 2 parameters"},
        Refused{"parameter_outside", "parameter b: lies outside"},
        Refused{"parameter_far_outside", "parameter b: lies outside"},
        Refused{"parameter_twice", "two parameters called a"},
        Refused{"parameter_overlap", "two parameters share bytes"},
        Refused{"parameter_unaligned", "parameter b: badly aligned"},
        Refused{"parameter_type", "unknown type 99"},
        Refused{"parameter_unnamed", "a parameter without a name"},
        Refused{"frequency_value", "parameter b: cannot have this frequency"},
        Refused{"frequency_size", "cannot change by hit in a structure of 32768 bytes"},
        Refused{"frequency_type", "parameter b: cannot have this frequency"},
        Refused{"parameter_default", "default that is not finite"},
        Refused{"parameter_range", "its range is empty"}),
    [](const auto& info) { return std::string(info.param.library); });

TEST(Registry, LoadsAGoodPluginOnce) {
  const ShaderRegistry registry({plugins});
  const RtsClass& everything = registry.find("Everything", "everything");
  EXPECT_EQ(everything.kind, RTS_SURFACE);
  EXPECT_EQ(everything.paramCount, 10u);
  EXPECT_STREQ(everything.params[1].name, "strength");
  EXPECT_EQ(&everything, &registry.find("Everything", "everything"));
  EXPECT_EQ(registry.find("Lamp", "everything").kind, RTS_LIGHT);
}

TEST(Registry, AShorterClassLacksTheNewerFunctions) {
  const ShaderRegistry registry({plugins});
  const RtsClass& example = registry.find("Example", "shorter_class");
  EXPECT_LT(example.size, sizeof(RtsClass));
  EXPECT_NE(example.traits, nullptr);
  EXPECT_NE(example.shade, nullptr);
  EXPECT_EQ(example.transmit,
            nullptr); // present in the plug-in's memory, but beyond the stated size
  EXPECT_EQ(example.generate, nullptr);
}

TEST(Registry, HalfAPointerIsNone) {
  const ShaderRegistry registry({plugins});
  const RtsClass& c = registry.find("Example", "class_truncated");
  EXPECT_NE(c.shade, nullptr);
  EXPECT_EQ(c.transmit, nullptr);
}

// Sizes and offsets of 1.0, in bytes on 64-bit machines. Offsets never change; sizes may grow.
TEST(Abi, StructuresGrowAtTheirEndsAlone) {
  if (sizeof(void*) != 8) GTEST_SKIP();
  EXPECT_EQ(offsetof(RtsClass, traits), 40u);
  EXPECT_EQ(offsetof(RtsClass, radiance), 152u);
  EXPECT_EQ(offsetof(RtsClass, opening), 160u);
  EXPECT_EQ(sizeof(RtsClass), 168u);
  EXPECT_EQ(sizeof(RtsParam), 96u);
  EXPECT_EQ(sizeof(RtsPlugin), 24u);
  EXPECT_EQ(offsetof(RtsHost, lobe), 64u);
  EXPECT_EQ(offsetof(RtsHost, backdrop), 152u);
  EXPECT_EQ(offsetof(RtsHost, sampleVolume), 160u);
  EXPECT_EQ(offsetof(RtsHost, pixels), 168u);
  EXPECT_EQ(sizeof(RtsHost), 176u);
  EXPECT_EQ(offsetof(RtsHits, segment) + sizeof(void*), sizeof(RtsHits));
}

TEST(Registry, PrefixAndSuffixDoNotMatter) {
  const ShaderRegistry registry({plugins});
  const RtsClass* everything = &registry.find("Everything", "everything");
  for (const char* spelling : {"libeverything", "everything.so", "libeverything.so"})
    EXPECT_EQ(&registry.find("Everything", spelling), everything) << spelling;
  EXPECT_EQ(registry.find("Everything", "prefixed").paramCount, 10u);
}

TEST(Registry, TakesNoPaths) {
  const ShaderRegistry registry({plugins + "/stock"});
  for (const char* name : {"../everything", "/absolute/x", "a/b", "..", ".hidden", "a\\b", "x..so"})
    EXPECT_NE(refusal(registry, "Everything", name).find("only a bare name is allowed"),
              std::string::npos)
        << name;
  EXPECT_NE(refusal(registry, "Everything", std::string("a\0b", 3)).find("only a bare name"),
            std::string::npos);
  EXPECT_NE(refusal(registry, "Everything", std::string(1000, 'x')).find("only a bare name"),
            std::string::npos);
}

TEST(Registry, SaysWhereItLooked) {
  const ShaderRegistry registry({"/nonexistent/one", plugins});
  const std::string text = refusal(registry, "Everything", "absent");
  EXPECT_NE(text.find("\"absent\""), text.npos) << text;
  EXPECT_NE(text.find("/nonexistent/one"), text.npos) << text;
  EXPECT_NE(text.find(plugins), text.npos) << text;
  const std::string noClass = refusal(registry, "Nothing", "everything");
  EXPECT_NE(noClass.find("has no class \"Nothing\"; it has: Everything, Plain, Lamp, Eye, Sky"),
            noClass.npos)
      << noClass;
}

TEST(Registry, StockClassesComeFromTheirOwnLibraryOrVrml97) {
  const ShaderRegistry registry({plugins + "/stock", plugins});
  EXPECT_EQ(registry.find("PerspectiveCamera", "").kind, RTS_CAMERA);
  EXPECT_EQ(registry.find("Everything", "").kind, RTS_SURFACE); // the library `everything`
  EXPECT_NE(refusal(registry, "NoSuchClass", "").find("there is no shader class \"NoSuchClass\""),
            std::string::npos);
  const ShaderRegistry without({plugins});
  EXPECT_NE(refusal(without, "PerspectiveCamera", "").find("vrml97 is missing"), std::string::npos);
}

TEST(Registry, EarlierFoldersWin) {
  const ShaderRegistry stockFirst({plugins + "/stock", plugins});
  EXPECT_EQ(refusal(stockFirst, "OrthographicCamera", "vrml97"), "");
}

TEST(Registry, RefusesFoldersThatAnybodyMayWriteTo) {
  const fs::path folder =
      fs::temp_directory_path() / ("openrt_registry_" + std::to_string(::getpid()));
  fs::create_directory(folder);
  fs::copy_file(plugins + "/everything.so", folder / "everything.so",
                fs::copy_options::overwrite_existing);
  const ShaderRegistry registry({folder.string()});
  ASSERT_EQ(::chmod(folder.c_str(), 0777), 0);
  const std::string text = refusal(registry, "Everything", "everything");
  EXPECT_NE(text.find("refused: others may write to it"), text.npos) << text;
  ASSERT_EQ(::chmod(folder.c_str(), 0755), 0);
  EXPECT_EQ(refusal(registry, "Everything", "everything"), "");
  fs::remove_all(folder);
}

TEST(Registry, RefusesWhatAGroupOrSomebodyAboveMayReplace) {
  const fs::path above = fs::temp_directory_path() / ("openrt_above_" + std::to_string(::getpid()));
  const fs::path folder = above / "shaders", file = folder / "everything.so";
  fs::create_directories(folder);
  fs::copy_file(plugins + "/everything.so", file, fs::copy_options::overwrite_existing);
  const ShaderRegistry registry({folder.string()});
  const auto refused = [&](const char* what, mode_t modeAbove, mode_t modeFolder, mode_t modeFile,
                           const std::string& why) {
    ASSERT_EQ(::chmod(above.c_str(), modeAbove) | ::chmod(folder.c_str(), modeFolder) |
                  ::chmod(file.c_str(), modeFile),
              0);
    const std::string text = refusal(registry, "Everything", "everything");
    EXPECT_NE(text.find(why), text.npos) << what << ": " << text;
  };
  refused("a folder above that anybody may write to", 0777, 0755, 0644,
          "others may write to " + fs::canonical(above).string() + ", above it");
  refused("a file that anybody may write to", 0755, 0755, 0666,
          "everything.so is refused: others may write to it");
  refused("the sticky bit does not keep others from adding files", 0755, 01777, 0644,
          "others may write to it");
  // A group that no user has as primary group; only root can give a file away.
  const gid_t group = 12345;
  if (::geteuid() == 0) {
    for (const fs::path& place : {above, folder, file})
      ASSERT_EQ(::chown(place.c_str(), gid_t(-1), group), 0);
    refused("a folder that a group may write to", 0755, 0775, 0644,
            "refused: others may write to it");
    refused("a file that a group may write to", 0755, 0755, 0664,
            "everything.so is refused: others may write to it");
    refused("a folder above that a group may write to", 0775, 0755, 0644, "above it");
    for (const fs::path& place : {above, folder, file})
      ASSERT_EQ(::chown(place.c_str(), gid_t(-1), ::getegid()), 0);
  }
  ASSERT_EQ(::chmod(above.c_str(), 01777) | ::chmod(folder.c_str(), 0755) |
                ::chmod(file.c_str(), 0644),
            0); // like /tmp
  EXPECT_EQ(refusal(registry, "Everything", "everything"), "");
  fs::remove_all(above);
}

// Only root can give files away and act as another user.
TEST(Registry, RefusesWhatBelongsToAnotherUserOrLiesInHisFolder) {
  if (::geteuid() != 0) GTEST_SKIP() << "needs root";
  constexpr uid_t other = 12345, user = 12346;
  const fs::path above =
      fs::temp_directory_path() / ("openrt_owners_" + std::to_string(::getpid()));
  const fs::path folder = above / "shaders", file = folder / "everything.so";
  fs::create_directories(folder);
  fs::copy_file(plugins + "/everything.so", file, fs::copy_options::overwrite_existing);
  for (const fs::path& place : {above, folder}) ASSERT_EQ(::chmod(place.c_str(), 0755), 0);
  const ShaderRegistry registry({folder.string()});
  const std::string belongs = " belongs to another user",
                    aboveIt = fs::canonical(above).string() + ", above it," + belongs;
  const auto refused = [&](const fs::path& place, const std::string& why) {
    ASSERT_EQ(::chown(place.c_str(), other, other), 0);
    const std::string text = refusal(registry, "Everything", "everything");
    EXPECT_NE(text.find(why), text.npos) << text;
    ASSERT_EQ(::seteuid(user), 0);
    const std::string forUser = plugin_files::objection(file.string());
    ASSERT_EQ(::seteuid(0), 0);
    EXPECT_NE(forUser.find(belongs), text.npos) << place << ": " << forUser;
    // The user's own folder, which root does not trust.
    ASSERT_EQ(::chown(place.c_str(), user, user), 0);
    ASSERT_EQ(::seteuid(user), 0);
    EXPECT_EQ(plugin_files::objection(file.string()), "");
    ASSERT_EQ(::seteuid(0), 0);
    EXPECT_NE(plugin_files::objection(file.string()), "");
    ASSERT_EQ(::chown(place.c_str(), 0, 0), 0);
  };
  refused(file, "everything.so is refused: it" + belongs);
  refused(folder, "refused: it" + belongs);
  refused(above, aboveIt);
  EXPECT_EQ(refusal(registry, "Everything", "everything"), "");
  fs::remove_all(above);
}

TEST(Registry, AGroupOfOneIsItsOwner) {
  EXPECT_TRUE(plugin_files::isPrivateGroup(0, 0)); // root
  EXPECT_FALSE(plugin_files::isPrivateGroup(0, 1));
  EXPECT_TRUE(plugin_files::isPrivateGroup(3000000001u, 3000000001u))
      << "neither is known, as in containers";
  EXPECT_FALSE(plugin_files::isPrivateGroup(3000000001u, 3000000002u));
  EXPECT_FALSE(plugin_files::isPrivateGroup(3000000001u, 0));
}

TEST(Registry, AFileThatIsNoLibraryIsRefused) {
  const fs::path folder =
      fs::temp_directory_path() / ("openrt_nolibrary_" + std::to_string(::getpid()));
  fs::create_directory(folder);
  ASSERT_EQ(::chmod(folder.c_str(), 0755), 0);
  std::ofstream(folder / "text.so") << "this is no shared library\n";
  const ShaderRegistry registry({folder.string()});
  EXPECT_NE(refusal(registry, "Everything", "text").find("text.so"), std::string::npos);
  fs::remove_all(folder);
}

TEST(ShaderFolders, ConfiguredThenEnvironment) {
  ::setenv("OPENRT_SHADER_PATH", "/from/environment::/second", 1);
  const std::vector<std::string> folders = shaderFolders("/one:/two:");
  ::unsetenv("OPENRT_SHADER_PATH");
  ASSERT_GE(folders.size(), 4u);
  EXPECT_EQ(folders[0], "/one");
  EXPECT_EQ(folders[1], "/two");
  EXPECT_EQ(folders[2], "/from/environment");
  EXPECT_EQ(folders[3], "/second");
}

} // namespace
