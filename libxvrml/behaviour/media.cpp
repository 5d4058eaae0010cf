#include "behaviour/media.h"

#include <cmath>
#include <exception>

#include <fmt/format.h>

#include "behaviour/named_fields.h"
#include "xvrml/browser.h"

namespace xvrml {
namespace {

Media& mediaOf(Events& events, Node& node) { return *static_cast<Media*>(events.state(node)); }

void send(Events& events, Node& node, Media& media, const TimeStep& step) {
  if (!step.running) return;
  if (step.begins) sendFrom<"isActive">(events, node, true);
  if (step.resumes) sendFrom<"isPaused">(events, node, false);
  media.play(events, node, step);
  if (!step.alreadySent) sendFrom<"elapsedTime">(events, node, step.elapsed);
  if (step.pauses) sendFrom<"isPaused">(events, node, true);
  if (step.ends) sendFrom<"isActive">(events, node, false);
}

MaySend maySend(const Events& events, const Node& node) {
  return {!events.hasSent(node, *fieldNamed<"isActive">(node)),
          !events.hasSent(node, *fieldNamed<"isPaused">(node))};
}

bool isRate(const Node& node, const FieldInfo& field) {
  return isField<"pitch">(node, field) || isField<"speed">(node, field);
}

bool accept(Events& events, Node& node, const FieldInfo& field, const Value& value) {
  const Media& media = mediaOf(events, node);
  if (isRate(node, field) &&
      (media.time.active() || !inRange(field, value) || !std::isfinite(std::get<SFFloat>(value))))
    return false;
  return media.time.accepts(media.fields(node), node, field, value);
}

void receive(Events& events, Node& node, const FieldInfo& in, const Value&) {
  Media& media = mediaOf(events, node);
  if (isField<"url">(node, in)) {
    media.duration = media.load(events, node);
    sendFrom<"duration_changed">(events, node, media.duration);
  }
  const TimeFields fields = media.fields(node);
  const TimeStep step = media.time.fieldChanged(fields, events.now(), maySend(events, node),
                                                isField<"startTime">(node, in));
  send(events, node, media, step);
  events.wantTicks(node, media.time.wantsTicks(fields, events.now()));
}

void tick(Events& events, Node& node) {
  Media& media = mediaOf(events, node);
  const TimeFields fields = media.fields(node);
  send(events, node, media, media.time.tick(fields, events.now(), maySend(events, node)));
  if (!media.time.wantsTicks(fields, events.now())) events.wantTicks(node, false);
}

} // namespace

void addMedia(const AddBehaviour& add, const NodeType& type,
              std::unique_ptr<NodeState> (*begin)(Events&, Node&)) {
  add(type, {.begin = begin, .accept = accept, .receive = receive, .tick = tick});
}

std::unique_ptr<NodeState> beginMedia(Events& events, Node& node, std::unique_ptr<Media> state) {
  state->duration = state->load(events, node);
  sendFrom<"duration_changed">(events, node, state->duration);
  const TimeFields fields = state->fields(node);
  state->time.begin(fields, events.now());
  if (state->time.wantsTicks(fields, events.now())) events.wantTicks(node, true);
  return state;
}

const LoadOptions& loadOptions(const Events& events) {
  static const LoadOptions defaults{};
  return events.browser() ? events.browser()->world().options : defaults;
}

Share mediaShare(const Events& events) {
  return events.browser() ? Share(budgetOf(events.browser()->world())) : Share();
}

std::string overBudgetMessage(uint64_t bytes, const Budget& budget) {
  return fmt::format("together with the rest of the world, its {} bytes are more than {}", bytes,
                     budget.name());
}

bool readFirst(Events& events, const Node& node, const MFString& urls,
               const std::function<bool(const std::string& path)>& read) {
  std::string error;
  for (const std::string& url : urls) {
    const ResolvedUrl resolved =
        resolveUrl(url, node.source.file ? *node.source.file : std::string(), loadOptions(events));
    std::string why = resolved.error;
    try {
      if (why.empty() && read(resolved.path)) return true;
    } catch (const std::exception& failure) { why = failure.what(); }
    if (error.empty()) error = why.find(url) == std::string::npos ? url + ": " + why : why;
  }
  if (!urls.empty())
    events.diagnostics().warn(node.source,
                              fmt::format("{}: nothing to play: {}", node.type().name, error));
  return false;
}

} // namespace xvrml
