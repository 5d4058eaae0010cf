// x3d_xml.h: the reader of X3D in XML (ISO/IEC 19776-1). [the thread that loads]
#pragma once

#include "parse/x3d_elements.h"
#include "parse/xml_text.h"

namespace xvrml {

// Reads a file. Text that is not well-formed ends it: what stands before is kept. The locator is
// that of text.text().
void readX3dXml(const XmlText& text, Locator& locator, X3dElements& elements);

} // namespace xvrml
