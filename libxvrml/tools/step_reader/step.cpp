// step.cpp: reads a STEP file (ISO 10303-21, application protocols 203, 214 and 242) by Open
// CASCADE: the tree of assemblies with its names, places and colours.
#include "step.h"

#include <map>
#include <new>
#include <stdexcept>
#include <streambuf>
#include <string_view>
#include <utility>

#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <Standard_ErrorHandler.hxx>
#include <Standard_OutOfMemory.hxx>
#include <Standard_Version.hxx>
#include <TCollection_AsciiString.hxx>
#include <TDF_Tool.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <XCAFPrs_DocumentExplorer.hxx>
#include <gp_Quaternion.hxx>

#include "facets.h"
#include "numbers.h"
#include "origins.h"

namespace xvrml::decoding {
namespace {

constexpr double metres = .001; // in a millimetre

// Reads the bytes of the file in place.
struct Bytes : std::streambuf {
  explicit Bytes(std::span<const uint8_t> file) {
    char* const begin = const_cast<char*>(reinterpret_cast<const char*>(file.data()));
    setg(begin, begin, begin + file.size());
  }
};

// Returns a message without its frame: "**** ERR StepFile : Undefined Parsing: Line 3: ...  ****".
std::string plain(std::string text) {
  constexpr std::string_view head = "Parsing: ", frame = "* ";
  if (const size_t at = text.find(head); at != text.npos) text.erase(0, at + head.size());
  text.erase(0, text.find_first_not_of(frame));
  text.erase(text.find_last_not_of(frame) + 1);
  return text;
}

// Keeps the first failure that Open CASCADE reports.
class FirstFailure : public Message_Printer {
  DEFINE_STANDARD_RTTI_INLINE(FirstFailure, Message_Printer)
 public:
  const std::string& text() const { return text_; }

 protected:
  void send(const TCollection_AsciiString& text, const Message_Gravity gravity) const override {
    if (gravity >= Message_Fail && text_.empty()) text_ = plain(text.ToCString());
  }

 private:
  mutable std::string text_;
};

std::string nameOf(const TDF_Label& label) {
  Handle(TDataStd_Name) name;
  if (label.IsNull() || !label.FindAttribute(TDataStd_Name::GetID(), name)) return {};
  return TCollection_AsciiString(name->Get()).ToCString(); // UTF-8
}

// Names of instances that programs make up: "=>[0:1:1:2]", "NAUO12", "12".
bool saysNothing(const std::string& name) {
  return name.starts_with("=>[") || name.starts_with("NAUO") ||
         name.find_first_not_of("0123456789 ") == name.npos;
}

class Tree {
 public:
  Tree(Model& model, double chordError) : model_(model), facets_(model, chordError) {}

  void read(const Handle(TDocStd_Document) & document) {
    std::vector<size_t> above; // the assemblies around a node
    size_t hiddenBelow = SIZE_MAX;
    XCAFPrs_DocumentExplorer all(document, XCAFPrs_DocumentExplorerFlags_None);
    for (; all.More(); all.Next()) {
      const XCAFPrs_DocumentNode& from = all.Current();
      const auto depth = size_t(std::max(all.CurrentDepth(), 0));
      if (depth > hiddenBelow) continue;
      hiddenBelow = from.Style.IsVisible() ? SIZE_MAX : depth;
      if (!from.Style.IsVisible()) continue;
      above.resize(std::min(above.size(), depth));
      const size_t number = model_.nodes.size();
      model_.nodes.push_back(nodeOf(from));
      (above.empty() ? model_.roots : model_.nodes[above.back()].children).push_back(number);
      if (from.IsAssembly) above.push_back(number);
    }
  }

 private:
  ModelNode nodeOf(const XCAFPrs_DocumentNode& from) {
    ModelNode node;
    const std::string part = nameOf(from.RefLabel);
    node.name = nameOf(from.Label);
    if (saysNothing(node.name)) node.name = part;
    const gp_Trsf place = from.LocalTrsf.Transformation();
    const gp_XYZ move = place.TranslationPart() * metres;
    const gp_Quaternion turn = place.GetRotation();
    node.translation = {move.X(), move.Y(), move.Z()};
    node.rotation = {turn.X(), turn.Y(), turn.Z(), turn.W()};
    node.scale = place.ScaleFactor();
    if (!from.IsAssembly && !from.RefLabel.IsNull()) node.mesh = meshOf(from, part);
    return node;
  }

  // Instances of a part that have the same style share its mesh.
  std::optional<size_t> meshOf(const XCAFPrs_DocumentNode& from, const std::string& name) {
    TCollection_AsciiString entry;
    TDF_Tool::Entry(from.RefLabel, entry);
    std::pair<std::string, std::vector<float>> key = {entry.ToCString(), {}};
    if (from.Style.IsSetColorSurf()) {
      const Quantity_ColorRGBA& color = from.Style.GetColorSurfRGBA();
      const Quantity_Color& rgb = color.GetRGB();
      key.second = {float(rgb.Red()), float(rgb.Green()), float(rgb.Blue()), color.Alpha()};
    }
    const auto [known, added] = meshes_.try_emplace(std::move(key));
    if (added) known->second = facets_.meshOf(from.RefLabel, name, from.Style);
    return known->second;
  }

  Model& model_;
  Facets facets_;
  std::map<std::pair<std::string, std::vector<float>>, std::optional<size_t>> meshes_;
};

Model modelOf(std::span<const uint8_t> file, double chordError) {
  const Handle(FirstFailure) failure = new FirstFailure();
  Message::DefaultMessenger()->AddPrinter(failure);
  const auto fail = [&](const char* otherwise) {
    throw std::runtime_error(failure->text().empty() ? otherwise : failure->text());
  };
  checkNumbers({reinterpret_cast<const char*>(file.data()), file.size()});
  Bytes bytes(file);
  std::istream text(&bytes);
  STEPCAFControl_Reader reader;
  reader.SetColorMode(true);
  reader.SetNameMode(true);
  if (reader.ChangeReader().ReadStream("model", text) != IFSelect_RetDone)
    fail("it is no STEP file that can be read");
  Handle(TDocStd_Document) document = new TDocStd_Document("XCAF");
  if (!reader.Transfer(document)) fail("it holds no model");
  Model model;
  Tree(model, chordError).read(document);
  if (model.meshes.empty()) fail("it holds no surfaces");
  return model;
}

} // namespace

void prepareStep() {
  Message::DefaultMessenger()->ChangePrinters().Clear();
  STEPCAFControl_Controller::Init();
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
}

void decodeStep(const Request& request, std::span<const uint8_t> file, Answer& answer) {
  GlbParts parts;
  Contents contents{0, 1, 1, 1};
  try {
    Model model = modelOf(file, request.chordError);
    const Extent extent = moveOrigins(model);
    contents.leftOut = model.leftOut;
    contents.away = extent.away;
    contents.size = extent.size;
    parts = writeGlb(std::move(model), "Open CASCADE " OCC_VERSION_STRING_EXT);
  } catch (const Standard_OutOfMemory&) {
    throw std::bad_alloc();
  } catch (const Standard_Failure& failure) { // is no std::exception
    throw std::runtime_error(std::string("Open CASCADE fails: ") + failure.GetMessageString());
  }
  contents.columns = parts.head.size() + parts.numbers.size();
  answer.contents(contents);
  answer.add(parts.head.data(), parts.head.size());
  answer.add(parts.numbers.data(), parts.numbers.size());
}

} // namespace xvrml::decoding
