// picture_quality.cpp: the values of quality settings, and what is known about them.
#include <gtest/gtest.h>

#include <stdexcept>

#include "libpicture/quality.h"

using namespace picture;

TEST(Quality, ValuesBeginAsTheDefaultsOfTheLibrary) {
  QualityValues values;
  for (const RTqualityInfo& info : qualityTable())
    EXPECT_EQ(values[info.quality], info.defaultValue) << info.name;
  EXPECT_EQ(values, QualityValues());
  values.set(RT_MAX_DEPTH, 3);
  EXPECT_EQ(values.whole(RT_MAX_DEPTH), 3);
  EXPECT_NE(values, QualityValues());
  EXPECT_THROW(values.set(99, 1), std::out_of_range);
  EXPECT_THROW((void)values[99], std::out_of_range);
}

TEST(Quality, NamesOfValuesAreThoseOfTheLibrary) {
  EXPECT_EQ(qualityNamed(RT_TRANSPORT, "path").value_or(-1), int(RT_TRANSPORT_PATH));
  EXPECT_FALSE(qualityNamed(RT_TRANSPORT, "pat"));
  EXPECT_FALSE(qualityNamed(RT_MAX_DEPTH, "path"));
  EXPECT_TRUE(qualityChoiceList(RT_TRANSPORT).starts_with("auto, direct, whitted, path"));
  EXPECT_TRUE(isSwitch(RT_SHADOWS));
  EXPECT_FALSE(isSwitch(RT_TRANSPORT));
  EXPECT_FALSE(isSwitch(RT_SEED));
}

TEST(Quality, FaultsReadAsThoseOfTheLibrary) {
  const RTcontext context = rtNewContext("backend=null");
  for (const RTqualityInfo& info : qualityTable()) {
    if (info.quality == RT_SEED) continue;
    const std::string function = info.isReal ? "rtQualityf" : "rtQuality";
    if (info.isReal)
      rtQualityf(info.quality, -1);
    else
      rtQuality(info.quality, -1);
    EXPECT_EQ(rtGetError(), RTenum(RT_INVALID_VALUE)) << info.name;
    EXPECT_EQ(rtGetErrorMessage(), function + ": " + qualityFault(info, info.name, -1));
  }
  rtDeleteContext(context);
}

TEST(Quality, AllValuesAreAppliedButThoseOfTheContext) {
  const RTcontext context = rtNewContext("backend=null");
  QualityValues values;
  values.set(RT_FRAMES_IN_FLIGHT, 1000); // out of range: an error if it were applied
  applyQuality(values);
  EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR));
  for (const RTqualityInfo& info : qualityTable()) {
    if (info.quality == RT_FRAMES_IN_FLIGHT || info.quality == RT_PATIENCE) continue;
    if (info.quality == RT_SEED) continue;
    QualityValues wrong;
    wrong.set(info.quality, -1);
    applyQuality(wrong);
    EXPECT_EQ(rtGetError(), RTenum(RT_INVALID_VALUE)) << info.name;
  }
  rtDeleteContext(context);
}
