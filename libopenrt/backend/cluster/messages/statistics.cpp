#include "backend/cluster/messages/statistics.h"

#include <algorithm>
#include <concepts>
#include <cstring>
#include <limits>
#include <string_view>
#include <vector>

#include "backend/cluster/messages/limits.h"
#include "backend/cluster/messages/text.h"

namespace openrt::cluster {
namespace {

std::string_view nameOf(const wire::Statistic& statistic) {
  return statistic.name() ? std::string_view(statistic.name()->c_str(), statistic.name()->size())
                          : std::string_view();
}

// Sends a member. Doubles hold counts exactly up to 2^53.
double valueOf(double value) { return value; }
template <std::unsigned_integral T> double valueOf(T count) { return double(count); }
template <size_t n> double valueOf(const char (&)[n]) { return 0; }

template <class T> Text textOf(const T&) { return {}; }
template <size_t n> Text textOf(const char (&text)[n]) {
  return std::string(text, strnlen(text, n));
}

// Receive a member. Larger counts than the member can hold become its largest.
void take(const wire::Statistic& from, double& value) { value = from.value(); }
template <std::unsigned_integral T> void take(const wire::Statistic& from, T& count) {
  constexpr T most = std::numeric_limits<T>::max();
  demand(from.value() >= 0, "a statistic is not a count: it is negative or NaN"); // rejects NaN too
  count = from.value() >= double(most) ? most : T(from.value());
}
template <size_t n> void take(const wire::Statistic& from, char (&text)[n]) {
  if (!from.text()) return;
  const size_t length = std::min<size_t>(from.text()->size(), n - 1);
  std::memcpy(text, from.text()->c_str(), length);
  text[length] = 0;
  clean({text, std::strlen(text)}); // cutting may have split a character
}

} // namespace

flatbuffers::Offset<StatisticsVector> writeStatistics(flatbuffers::FlatBufferBuilder& builder,
                                                      const RTstats& stats) {
  std::vector<flatbuffers::Offset<wire::Statistic>> all;
  forEachStatistic(stats, [&](const char* name, const auto& member) {
    const wire::StatisticT statistic{
        .name = name, .value = valueOf(member), .text = textOf(member)};
    if (statistic.value != 0 || !statistic.text.empty())
      all.push_back(wire::Statistic::Pack(builder, &statistic));
  });
  return builder.CreateVector(all);
}

void checkStatistics(const StatisticsVector* from) {
  if (!from) return;
  demand(from->size() <= limits::statistics, "too many statistics");
  for (const wire::Statistic* statistic : *from) {
    demand(nameOf(*statistic).size() <= limits::textBytes, "a text is too long");
    demand(!statistic->text() || statistic->text()->size() <= limits::textBytes,
           "a text is too long");
  }
}

RTstats readStatistics(const StatisticsVector* from) {
  RTstats stats{};
  stats.size = sizeof stats;
  if (!from) return stats;
  for (const wire::Statistic* statistic : *from)
    forEachStatistic(stats, [&](std::string_view name, auto& member) {
      if (name == nameOf(*statistic)) take(*statistic, member);
    });
  return stats;
}

} // namespace openrt::cluster
