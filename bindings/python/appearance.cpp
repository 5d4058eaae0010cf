// appearance.cpp: Makes the tuples that Python sees of an appearance (xvrml/_renderer.py), and
// implements World.texture_picture(). [GIL held; released while pictures are read]
#include <algorithm>
#include <utility>

#include "appearance_object.h"
#include "arrays.h"

using namespace xvrml;

namespace {

py::tuple colorTuple(const Color& color) { return py::make_tuple(color.r, color.g, color.b); }

py::object materialObject(const WorldPtr& world, const MaterialValues& m) {
  constexpr const char* models[] = {"none", "phong", "physical", "unlit"};
  return classInPython("MaterialValues")(
      models[size_t(m.model)], colorTuple(m.color), colorTuple(m.emissiveColor),
      colorTuple(m.lineColor), colorTuple(m.specularColor), m.ambientIntensity, m.shininess,
      m.metallic, m.roughness, m.transparency, m.normalScale, asNode(world, m.colorTexture),
      asNode(world, m.emissiveTexture), asNode(world, m.specularTexture),
      asNode(world, m.ambientTexture), asNode(world, m.shininessTexture),
      asNode(world, m.normalTexture), asNode(world, m.metallicRoughnessTexture),
      asNode(world, m.occlusionTexture));
}

// Returns the radiances with the first row at the top.
py::object radianceArray(const RadianceImage& image) {
  auto array = newArray<float>({image.height, image.width, 3});
  const size_t row = size_t(image.width) * 3;
  float* to = array.mutable_data();
  for (size_t y = size_t(image.height); y-- > 0;)
    to = std::copy_n(image.rgb.begin() + std::ptrdiff_t(y * row), row, to);
  return array;
}

py::object texturePictureOf(const WorldPtr& self, const NodeObject& texture, bool decode) {
  const World& world = self->graph();
  TexturePicture picture;
  {
    const auto lock = self->lockGraph();
    const ReleaseGil release;
    picture = texturePicture(*texture.node, world, decode ? Decode::yes : Decode::no);
  }
  py::object array = py::none();
  if (picture.image.components > 0)
    array = toPython(Value(std::move(picture.image)), self);
  else if (!picture.radiance.rgb.empty())
    array = radianceArray(picture.radiance);
  const auto* bytes = reinterpret_cast<const char*>(picture.file.data());
  return classInPython("TexturePicture")(std::move(array), py::bytes(bytes, picture.file.size()),
                                         toText(picture.path), toText(picture.type),
                                         toText(picture.error));
}

} // namespace

py::object classInPython(const char* name) {
  return py::module_::import("xvrml._renderer").attr(name);
}

py::object appearanceObject(const WorldPtr& world, const AppearanceParts& parts) {
  py::list layers;
  for (const TextureLayer& layer : textureLayers(parts))
    layers.append(classInPython("TextureLayer")(asNode(world, layer.texture),
                                                matrixArray(layer.transform), toText(layer.mode),
                                                toText(layer.source), toText(layer.function)));
  py::object back = py::none();
  if (const auto values = backValues(parts)) back = materialObject(world, *values);
  return classInPython("AppearanceParts")(
      asNode(world, parts.appearance), asNode(world, parts.material),
      asNode(world, parts.backMaterial), asNode(world, parts.texture),
      asNode(world, parts.textureTransform), asNode(world, parts.shader), parts.texturesMultiply(),
      materialObject(world, materialValues(parts.material)), std::move(back), layers);
}

void defineAppearance(py::module_& module) {
  py::object world = module.attr("World");
  py::reinterpret_borrow<py::class_<WorldObject, WorldPtr>>(world).def(
      "texture_picture", texturePictureOf, py::arg("node"), py::arg("decode") = true,
      "Returns the TexturePicture of an ImageTexture, a PixelTexture, or the frame that a "
      "MovieTexture of a running world shows now. decode=False reads a file without decoding it.");
}
