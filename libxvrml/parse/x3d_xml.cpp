// x3d_xml.cpp: the reader of X3D in XML (ISO/IEC 19776-1): hands the elements that expat finds to
// X3dElements, with their places. Attributes are taken from the file's own bytes, except where XML
// decodes them.
#include "parse/encodings.h"

#include <algorithm>
#include <cstring>
#include <exception>
#include <memory>
#include <optional>

#include <expat.h>
#include <fmt/format.h>

#include "parse/builder.h"
#include "parse/suffix.h"
#include "parse/x3d_elements.h"
#include "parse/xml_recorder.h"
#include "parse/xml_text.h"

namespace xvrml {
namespace {

class Reader {
 public:
  // layout: gets the index of the text; null: nothing does.
  Reader(const XmlText& text, Locator& locator, X3dElements& elements, TextLayout* layout)
      : text_(text), locator_(locator), elements_(elements), layout_(layout),
        // The text is in UTF-8, whatever its declaration says.
        parser_(XML_ParserCreate("UTF-8")) {
    if (!parser_) throw std::bad_alloc();
    // Entities in other files and parameter entities are not read: expat does not unless it is told
    // to. It limits by itself how much entities within the file may grow.
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(parser_.get(), openElement, closeElement);
    XML_SetCharacterDataHandler(parser_.get(), readCharacters);
    XML_SetSkippedEntityHandler(parser_.get(), skipEntity);
    XML_SetExternalEntityRefHandler(parser_.get(), leaveEntityOut);
    XML_SetExternalEntityRefHandlerArg(parser_.get(), this);
  }

  void read() {
    // expat takes the length as an int.
    constexpr size_t step = size_t(1) << 30;
    std::string_view rest = text_.shortText();
    XML_Status status = XML_STATUS_OK;
    do {
      const std::string_view part = rest.substr(0, step);
      rest.remove_prefix(part.size());
      status = XML_Parse(parser_.get(), part.data(), static_cast<int>(part.size()),
                         rest.empty() ? 1 : 0);
    } while (status == XML_STATUS_OK && !rest.empty());
    if (failure_) std::rethrow_exception(failure_);
    if (status != XML_STATUS_OK) reportError();
  }

 private:
  struct Free {
    void operator()(XML_Parser parser) const { XML_ParserFree(parser); }
  };

  // Runs a handler. An exception must not pass through expat: it stops the parser.
  template <class Function> static void guarded(void* data, Function function) {
    auto& reader = *static_cast<Reader*>(data);
    if (reader.failure_) return;
    try {
      function(reader);
    } catch (...) {
      reader.failure_ = std::current_exception();
      XML_StopParser(reader.parser_.get(), XML_FALSE);
    }
  }

  static void XMLCALL openElement(void* data, const XML_Char* name, const XML_Char** attributes) {
    guarded(data, [&](Reader& reader) { reader.open(name, attributes); });
  }
  static void XMLCALL closeElement(void* data, const XML_Char*) {
    guarded(data, [](Reader& reader) {
      reader.elements_.close();
      if (reader.layout_) reader.layout_->xml.close(reader.place(), reader.placeBehind());
    });
  }
  static void XMLCALL readCharacters(void* data, const XML_Char* text, int size) {
    guarded(data, [&](Reader& reader) {
      const std::string_view part(text, static_cast<size_t>(size));
      reader.elements_.characters(reader.text_.restored(part, reader.offset(), reader.whole_),
                                  reader.place());
    });
  }
  static void XMLCALL skipEntity(void* data, const XML_Char* name, int isParameter) {
    guarded(data, [&](Reader& reader) {
      if (isParameter) return;
      reader.locator_.warn(reader.place(), fmt::format("the entity &{}; is not known here: it is "
                                                       "left out",
                                                       shortened(name)));
    });
  }

  // An entity in another file. Returning OK without a parser for it leaves it out.
  static int XMLCALL leaveEntityOut(XML_Parser data, const XML_Char*, const XML_Char*,
                                    const XML_Char* file, const XML_Char*) {
    guarded(data, [&](Reader& reader) {
      reader.locator_.warn(reader.place(), fmt::format("an entity in the file '{}' is left out: "
                                                       "other files are not opened for XML",
                                                       shortened(file ? file : "")));
    });
    return XML_STATUS_OK;
  }

  size_t offset() const {
    return static_cast<size_t>(std::max<XML_Index>(XML_GetCurrentByteIndex(parser_.get()), 0));
  }
  const char* place() const { return text_.place(offset()); }
  // Returns the place behind the tag that has been read.
  const char* placeBehind() const {
    const int bytes = XML_GetCurrentByteCount(parser_.get());
    return text_.place(offset() + static_cast<size_t>(std::max(bytes, 0)));
  }

  void open(const char* name, const char** given) {
    const char* const at = place();
    const auto specified = static_cast<size_t>(XML_GetSpecifiedAttributeCount(parser_.get())) / 2;
    // An element that comes from an entity has no tag in the file.
    const bool hasTag = XmlText::findAttributes(text_.text(), at, attributes_) &&
                        attributes_.size() == specified && tagIs(at, name);
    if (!hasTag) attributes_.clear();
    if (layout_) layout_->xml.open(at, placeBehind(), attributes_);
    if (!hasTag) refuseEdits("has elements within entities of its document type");
    for (size_t i = 0; given[2 * i]; ++i) {
      const std::string_view decoded = given[2 * i + 1];
      if (i >= attributes_.size()) { // the document type gives it
        refuseEdits("gets values of attributes from its document type");
        attributes_.push_back({{given[2 * i], at}, decoded, at, true});
      } else if (attributes_[i].value.find('&') != std::string_view::npos) {
        attributes_[i].value = decoded;
        attributes_[i].decoded = true;
      }
    }
    const std::string_view element =
        hasTag ? std::string_view(at + 1, std::strlen(name)) : std::string_view(name);
    elements_.open({element, hasTag ? at + 1 : at}, attributes_);
  }

  bool tagIs(const char* at, std::string_view name) const {
    const std::string_view text = text_.text();
    return text.substr(static_cast<size_t>(at + 1 - text.data())).starts_with(name);
  }

  void refuseEdits(std::string_view reason) {
    if (layout_ && layout_->whyNot.empty()) layout_->whyNot = reason;
  }

  void reportError() {
    const XML_Error code = XML_GetErrorCode(parser_.get());
    refuseEdits("is not well-formed XML: mend it first");
    const char* const known = XML_ErrorString(code);
    locator_.error(place(), fmt::format("this is not well-formed XML: {}; what follows is left out",
                                        known ? known : "unknown error"));
  }

  const XmlText& text_;
  Locator& locator_;
  X3dElements& elements_;
  TextLayout* const layout_;
  std::unique_ptr<XML_ParserStruct, Free> parser_;
  std::vector<Attribute> attributes_;
  std::string whole_;
  std::exception_ptr failure_;
};

} // namespace

// Returns whether a text is X3D in XML: it begins with an element, and an X3D follows. Texts in
// UTF-16 have a zero beside each of these characters. The suffix decides where a long comment comes
// first.
bool isX3dXml(std::string_view text, std::string_view file) {
  std::string ascii;
  for (const char c : text.substr(0, 8192))
    if (c > 0) ascii += c;
  const size_t first = ascii.find_first_not_of(" \t\r\n");
  if (first == ascii.npos || ascii[first] != '<') return false;
  std::string begin = ascii.substr(first, 14);
  for (char& c : begin)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  // A page may hold a scene, but it is not well-formed XML.
  if (begin.starts_with("<html") || begin.starts_with("<!doctype html")) return false;
  constexpr std::string_view marks[] = {"<X3D", "<x3d", ":X3D", "<!DOCTYPE X3D"};
  return std::any_of(std::begin(marks), std::end(marks),
                     [&](std::string_view mark) { return ascii.find(mark) != ascii.npos; }) ||
         endsWithOneOf(file, {".x3d", ".x3dz", ".x3d.gz"});
}

// Text that is not well-formed ends the file: what stands before is kept.
void readX3dXml(const WorldFile& file) {
  const XmlText text(file.bytes, *file.name, file.budget);
  Locator locator(text.text(), file.name, file.state.diagnostics);
  Builder builder(locator, file.state, file.content);
  TextLayout* const layout = file.state.layout;
  std::optional<XmlRecorder> recorder;
  if (layout) {
    if (text.encoding() != "UTF-8")
      layout->whyNot =
          fmt::format("is in {}: only XML in UTF-8 can be edited", shortened(text.encoding()));
    // A text that is not in UTF-8 is a copy.
    layout->xml.begin(layout->whyNot.empty() ? file.bytes : text.text());
    recorder.emplace(builder, locator, *layout);
  }
  ParseSink& sink = recorder ? static_cast<ParseSink&>(*recorder) : builder;
  X3dElements elements(locator, file.state.options.limits, sink, file.budget.get(),
                       file.state.anyRoots);
  if (!text.complaint().empty()) locator.warn(text.text().data(), text.complaint());
  Reader(text, locator, elements, layout).read();
  elements.finish();
  builder.finish();
  if (!layout) return;
  if (layout->whyNot.empty() && !file.state.anyRoots && !layout->xml.scene())
    layout->whyNot = "has no Scene";
  if (layout->whyNot.empty())
    recorder->finish();
  else // the places may be those of a copy, or within entities
    *layout = {.whyNot = layout->whyNot};
}

} // namespace xvrml
