// common_base64.cpp: Tests the text of bytes against RFC 4648, section 10.
#include "base64.h"

#include <gtest/gtest.h>

TEST(Base64, IsThatOfTheStandard) {
  EXPECT_EQ(base64Of(""), "");
  EXPECT_EQ(base64Of("f"), "Zg==");
  EXPECT_EQ(base64Of("fo"), "Zm8=");
  EXPECT_EQ(base64Of("foo"), "Zm9v");
  EXPECT_EQ(base64Of("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64Of("\xff\xfe\xfd"), "//79");
}
