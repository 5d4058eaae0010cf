// plans.cpp: what each node type contributes to the picture: a dispatch table by type index with
// one small function per type. Called while the render graph is built, on the mapper's thread.
#include <algorithm>
#include <span>

#include "geometry/descend.h"
#include "geometry/figure.h"
#include "geometry/half_space.h"
#include "mapper/graph/graph.h"
#include "nodes/bindable.h"
#include "nodes/visible.h"
#include "xvrml/nodes.h"

namespace xvrml::mapper {
namespace {

void group(Plan& plan, const MFNode& children) {
  plan.kind = Kind::group;
  plan.add(children);
}

void planGroup(PlanContext&, Node& node, Plan& plan) {
  group(plan, static_cast<nodes::Group&>(node).children);
}
void planStaticGroup(PlanContext&, Node& node, Plan& plan) {
  group(plan, static_cast<nodes::StaticGroup&>(node).children);
}
void planAnchor(PlanContext&, Node& node, Plan& plan) {
  group(plan, static_cast<nodes::Anchor&>(node).children);
}
// The proxy is used for collision detection only (clause 6.8).
void planCollision(PlanContext&, Node& node, Plan& plan) {
  group(plan, static_cast<nodes::Collision&>(node).children);
}

void planTransform(PlanContext&, Node& node, Plan& plan) {
  group(plan, static_cast<nodes::Transform&>(node).children);
}

void planSwitch(PlanContext&, Node& node, Plan& plan) {
  plan.kind = Kind::group;
  if (Node* chosen = chosenChild(static_cast<nodes::Switch&>(node)))
    plan.children.push_back(chosen);
}

void planLod(PlanContext&, Node& node, Plan& plan) {
  plan.kind = Kind::lod;
  plan.keepEmpty = true;
  plan.add(static_cast<nodes::LOD&>(node).level);
}

void planBillboard(PlanContext&, Node& node, Plan& plan) {
  plan.kind = Kind::billboard;
  plan.add(static_cast<nodes::Billboard&>(node).children);
}

// Content that arrives later (Browser::loadInline) gets an object of its own, so that nothing else
// has to be rewritten then.
void planInline(PlanContext& context, Node& node, Plan& plan) {
  plan.kind = Kind::group;
  plan.isInline = true;
  const Scope* scope = inlineScope(node);
  const auto& content = static_cast<nodes::Inline&>(node);
  plan.awaited =
      !scope && !context.world.options.loadInlines && content.load && !content.url.empty();
  if (scope) plan.add(scope->roots);
  // Inline has the field `global` since ISO/IEC 19775-1:2023 (9.4.2).
  plan.limitsLights = versionOf(node).major >= 4 && !static_cast<nodes::Inline&>(node).global;
}

void planStatic(PlanContext&, Node& node, Plan& plan) {
  group(plan, static_cast<nodes::ORTStatic&>(node).children);
  plan.hint = Hint::merge;
}
void planInstance(PlanContext&, Node& node, Plan& plan) {
  group(plan, static_cast<nodes::ORTInstance&>(node).children);
  plan.hint = Hint::instantiate;
}

void planShape(PlanContext&, Node& node, Plan& plan) {
  if (renderedNode(static_cast<nodes::Shape&>(node).geometry.get())) plan.kind = Kind::shape;
}

// A light that is off illuminates nothing (clause 4.6.6). It is ignored unless events may turn it
// on (summary.cpp).
template <class Light> void planLight(Node& node, Kind kind, Plan& plan) {
  plan.kind = kind;
  plan.on = static_cast<Light&>(node).on;
}
// The defaults of `global` are the rules of VRML97 (clauses 6.16, 6.35 and 6.45), which lacks it.
template <class Light> void planScopedLight(Node& node, Kind kind, Plan& plan) {
  planLight<Light>(node, kind, plan);
  plan.scoped = !static_cast<Light&>(node).global;
}
void planDirectionalLight(PlanContext&, Node& node, Plan& plan) {
  planScopedLight<nodes::DirectionalLight>(node, Kind::directionalLight, plan);
}
void planPointLight(PlanContext&, Node& node, Plan& plan) {
  planScopedLight<nodes::PointLight>(node, Kind::localLight, plan);
}
void planSpotLight(PlanContext&, Node& node, Plan& plan) {
  planScopedLight<nodes::SpotLight>(node, Kind::localLight, plan);
}
void planEnvironmentLight(PlanContext&, Node& node, Plan& plan) {
  planLight<nodes::EnvironmentLight>(node, Kind::environmentLight, plan);
}

// The fog of a group and all below it (ISO/IEC 19775-1 24.4.4).
void planLocalFog(PlanContext&, Node& node, Plan& plan) {
  plan.kind = Kind::localFog;
  plan.on = static_cast<nodes::LocalFog&>(node).enabled;
  plan.scoped = true;
}

void planOrtLight(PlanContext&, Node& node, Plan& plan) {
  planLight<nodes::ORTLight>(node, Kind::localLight, plan);
}

// X3D clause 32: groups of drawings.
void planCadAssembly(PlanContext&, Node& node, Plan& plan) {
  group(plan, static_cast<nodes::CADAssembly&>(node).children);
}
void planCadPart(PlanContext&, Node& node, Plan& plan) {
  group(plan, static_cast<nodes::CADPart&>(node).children);
}
void planCadFace(PlanContext&, Node& node, Plan& plan) {
  plan.kind = Kind::group;
  plan.children.push_back(static_cast<nodes::CADFace&>(node).shape.get());
}
void planCadLayer(PlanContext&, Node& node, Plan& plan) {
  plan.kind = Kind::group;
  appendShownChildren(static_cast<nodes::CADLayer&>(node), plan.children);
}

// Groups that are placed without all that they can do (NodeType's `lacks`).
void planPlacing(PlanContext& context, Node& node, Plan& plan) {
  plan.kind = Kind::group;
  if (!node.live && deforms(node.type())) deform(node, &context.world.diagnostics);
  appendPlaced(node, plan.children);
}

void planViewpointGroup(PlanContext&, Node& node, Plan& plan) {
  group(plan, static_cast<nodes::ViewpointGroup&>(node).children);
}
void planSensor(PlanContext&, Node&, Plan& plan) { plan.kind = Kind::sensor; }
void planClipPlane(PlanContext& context, Node& node, Plan& plan) {
  plan.kind = Kind::clipPlane;
  const std::string fault = faultOf(static_cast<nodes::ClipPlane&>(node));
  if (!fault.empty()) context.world.diagnostics.warn(node.source, "ClipPlane: " + fault);
}
void planViewpoint(PlanContext&, Node&, Plan& plan) { plan.kind = Kind::viewpoint; }
void planBackground(PlanContext&, Node&, Plan& plan) { plan.kind = Kind::background; }
void planFog(PlanContext&, Node&, Plan& plan) { plan.kind = Kind::fog; }
void planNavigationInfo(PlanContext&, Node&, Plan& plan) { plan.kind = Kind::navigationInfo; }
// In the order of BindableStack.
constexpr PlanFunction bindablePlans[bindableStacks] = {planViewpoint, planBackground, planFog,
                                                        planNavigationInfo};

std::vector<PlanFunction>& table() {
  static std::vector<PlanFunction> plans = [] {
    std::vector<PlanFunction> t(nodeTypes().size(), nullptr);
    auto set = [&](int index, PlanFunction plan) {
      if (size_t(index) >= t.size()) t.resize(size_t(index) + 1, nullptr);
      t[size_t(index)] = plan;
    };
    set(nodes::Group::typeIndex, planGroup);
    set(nodes::StaticGroup::typeIndex, planStaticGroup);
    set(nodes::Anchor::typeIndex, planAnchor);
    set(nodes::Collision::typeIndex, planCollision);
    set(nodes::Transform::typeIndex, planTransform);
    set(nodes::CADAssembly::typeIndex, planCadAssembly);
    set(nodes::CADPart::typeIndex, planCadPart);
    set(nodes::CADFace::typeIndex, planCadFace);
    set(nodes::CADLayer::typeIndex, planCadLayer);
    set(nodes::Switch::typeIndex, planSwitch);
    set(nodes::LOD::typeIndex, planLod);
    set(nodes::Billboard::typeIndex, planBillboard);
    set(nodes::Inline::typeIndex, planInline);
    set(nodes::ORTStatic::typeIndex, planStatic);
    set(nodes::ORTInstance::typeIndex, planInstance);
    set(nodes::Shape::typeIndex, planShape);
    set(nodes::DirectionalLight::typeIndex, planDirectionalLight);
    set(nodes::PointLight::typeIndex, planPointLight);
    set(nodes::SpotLight::typeIndex, planSpotLight);
    set(nodes::EnvironmentLight::typeIndex, planEnvironmentLight);
    set(nodes::LocalFog::typeIndex, planLocalFog);
    set(nodes::ORTLight::typeIndex, planOrtLight);
    set(nodes::ORTSensor::typeIndex, planSensor);
    set(nodes::ClipPlane::typeIndex, planClipPlane);
    set(nodes::ViewpointGroup::typeIndex, planViewpointGroup);
    for (const NodeType* type : nodeTypes())
      if (type->is("placing")) set(type->index, planPlacing);
    for (const NodeType* type : nodeTypes())
      if (const BindableStack stack = bindableStack(*type); stack != BindableStack::none)
        set(type->index, bindablePlans[size_t(stack)]);
    return t;
  }();
  return plans;
}

} // namespace

PlanFunction planOf(const NodeType& type) {
  const std::vector<PlanFunction>& plans = table();
  return type.index >= 0 && size_t(type.index) < plans.size() ? plans[size_t(type.index)] : nullptr;
}

} // namespace xvrml::mapper
