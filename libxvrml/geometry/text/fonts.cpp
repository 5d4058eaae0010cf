// fonts.cpp: finds font files by family with fontconfig, and keeps the fonts in use.
#include "geometry/text/fonts.h"

#include <fontconfig/fontconfig.h>

#include <cstring>
#include <filesystem>

#include <dlfcn.h>

namespace xvrml {
namespace {

template <class T, void (*destroy)(T*)> struct Destroyer {
  void operator()(T* p) const { destroy(p); }
};
using Pattern = std::unique_ptr<FcPattern, Destroyer<FcPattern, FcPatternDestroy>>;

const FcChar8* fc(const char* s) { return reinterpret_cast<const FcChar8*>(s); }

// Adds bundled fonts if the system has none. An installation such as a wheel may bring fonts in
// share/xvrml/fonts beside lib. They include a configuration for systems without one of
// fontconfig's own, about which fontconfig would complain on standard error.
void addBundledFonts() {
  namespace fs = std::filesystem;
  static const char here = 0;
  std::error_code error;
  Dl_info info{};
  if (dladdr(&here, &info) == 0 || !info.dli_fname) return;
  const fs::path folder =
      fs::canonical(fs::path(info.dli_fname).parent_path() / "../share/xvrml/fonts", error);
  if (error) return;
  // This is used for queries only. Without it fontconfig would load its own and complain.
  FcConfig* own = FcConfigCreate();
  if (!own) return;
  if (FcChar8* installed = FcConfigGetFilename(own, nullptr)) {
    FcStrFree(installed);
    const FcFontSet* fonts = FcConfigGetFonts(nullptr, FcSetSystem);
    if (!fonts || fonts->nfont == 0) FcConfigAppFontAddDir(nullptr, fc(folder.c_str()));
  } else if (FcConfigParseAndLoad(own, fc((folder / "fonts.conf").c_str()), FcFalse)) {
    FcConfigSetCurrent(own); // this builds the list
  }
  FcConfigDestroy(own);
}

// Returns fontconfig's name of a standard family.
std::string fontconfigName(const std::string& family) {
  if (family == "SERIF" || family.empty()) return "serif";
  if (family == "SANS") return "sans-serif";
  if (family == "TYPEWRITER") return "monospace";
  return family;
}

struct Match {
  std::string file, family;
  int index = 0;
  // Style features that the file lacks and that are synthesised.
  bool slant = false, embolden = false;
};

bool match(const std::string& name, bool bold, bool italic, const std::string& language,
           Match& result) {
  static const bool prepared = (addBundledFonts(), true);
  (void)prepared;
  Pattern pattern(FcPatternCreate());
  if (!pattern) return false;
  FcPatternAddString(pattern.get(), FC_FAMILY, fc(name.c_str()));
  FcPatternAddInteger(pattern.get(), FC_WEIGHT, bold ? FC_WEIGHT_BOLD : FC_WEIGHT_NORMAL);
  FcPatternAddInteger(pattern.get(), FC_SLANT, italic ? FC_SLANT_ITALIC : FC_SLANT_ROMAN);
  FcPatternAddBool(pattern.get(), FC_OUTLINE, FcTrue);
  FcPatternAddBool(pattern.get(), FC_SCALABLE, FcTrue);
  if (!language.empty()) FcPatternAddString(pattern.get(), FC_LANG, fc(language.c_str()));
  FcConfigSubstitute(nullptr, pattern.get(), FcMatchPattern);
  FcDefaultSubstitute(pattern.get());
  FcResult outcome = FcResultNoMatch;
  Pattern found(FcFontMatch(nullptr, pattern.get(), &outcome));
  if (!found) return false;
  FcChar8 *file = nullptr, *family = nullptr;
  FcBool outline = FcFalse;
  if (FcPatternGetString(found.get(), FC_FILE, 0, &file) != FcResultMatch) return false;
  if (FcPatternGetBool(found.get(), FC_OUTLINE, 0, &outline) != FcResultMatch || !outline)
    return false;
  result.file = reinterpret_cast<const char*>(file);
  if (FcPatternGetString(found.get(), FC_FAMILY, 0, &family) == FcResultMatch)
    result.family = reinterpret_cast<const char*>(family);
  FcPatternGetInteger(found.get(), FC_INDEX, 0, &result.index);
  int weight = FC_WEIGHT_NORMAL, slant = FC_SLANT_ROMAN;
  FcPatternGetInteger(found.get(), FC_WEIGHT, 0, &weight);
  FcPatternGetInteger(found.get(), FC_SLANT, 0, &slant);
  result.slant = italic && slant == FC_SLANT_ROMAN;
  result.embolden = bold && weight <= FC_WEIGHT_MEDIUM;
  return true;
}

bool sameFamily(const std::string& wanted, const std::string& found) {
  return FcStrCmpIgnoreCase(fc(wanted.c_str()), fc(found.c_str())) == 0;
}

// Fonts by file and style, and earlier requests. Requests are forgotten from time to time, because
// a hostile world may use many names.
struct FontTable {
  std::map<std::string, std::shared_ptr<Font>> byFile;
  std::map<std::string, Font*> byRequest;
};
FontTable& table() {
  static FontTable fonts;
  return fonts;
}

Font* open(const Match& m) {
  std::string key =
      m.file + '\n' + std::to_string(m.index) + (m.slant ? "s" : "") + (m.embolden ? "e" : "");
  auto& fonts = table().byFile;
  auto found = fonts.find(key);
  if (found != fonts.end()) return found->second.get();
  std::shared_ptr<Font> font;
  try {
    font = std::make_shared<Font>(m.file, m.index, m.slant, m.embolden);
  } catch (const std::exception&) { // remembered as unusable
  }
  return fonts.emplace(key, font).first->second.get();
}

} // namespace

std::mutex& fontsMutex() {
  static std::mutex mutex;
  return mutex;
}

Font* findFont(std::span<const std::string> families, bool bold, bool italic,
               const std::string& language) {
  std::string request = language + (bold ? "\nb" : "\n") + (italic ? "i" : "");
  for (const std::string& family : families) request += '\n' + family;
  auto& requests = table().byRequest;
  if (auto found = requests.find(request); found != requests.end()) return found->second;
  Font* font = nullptr;
  size_t tried = 0;
  for (const std::string& family : families) {
    if (font || ++tried > 16) break;
    std::string name = fontconfigName(family);
    bool generic = name == "serif" || name == "sans-serif" || name == "monospace";
    Match m;
    // Fontconfig always returns some font, so use it only if the family matches.
    if (match(name, bold, italic, language, m) && (generic || sameFamily(name, m.family)))
      font = open(m);
  }
  Match m;
  if (!font && match("serif", bold, italic, language, m)) font = open(m);
  if (requests.size() > 1000) requests.clear();
  requests.emplace(request, font);
  return font;
}

} // namespace xvrml
