#include "src/identify/text_table.h"

#include "src/identify/input.h"
#include "tests/src/message_of.h"
#include "tests/src/temporary_folder.h"

#include <array>
#include <string>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::message_of;
using testing::TemporaryFolder;

constexpr std::array<std::string_view, 3> roles{"input", "output", "time"};

TextTable table_of(const std::string& text, std::string_view columns) {
    const TemporaryFolder folder;
    return read_text_table(folder.write("table.txt", text), parse_columns(columns, roles, 2));
}

TEST(TextTable, EverySeparator_IsSeen) {
    for (const char* text :
         {"1,2\n3,4\n", "1;2\n3;4\n", "1\t2\n3\t4\n", "  1   2\n3 4  \n", "+1,2\r\n3,4\r\n"}) {
        SCOPED_TRACE(text);
        const TextTable table = table_of(text, "input=1,output=2");
        EXPECT_THAT(table.columns[0].values, ElementsAre(1.0, 3.0));
        EXPECT_THAT(table.columns[1].values, ElementsAre(2.0, 4.0));
    }
}

TEST(TextTable, Titles_NameColumnsAndUnits) {
    const std::string text = "time,Control input [V],position [um]\n0,1,2000\n1,2,3000\n";
    const TextTable table = table_of(text, "input=Control input,output=position [um],time=time");
    EXPECT_THAT(values_in(table, "input", "V"), ElementsAre(1.0, 2.0));
    EXPECT_THAT(values_in(table, "output", "mm"), ElementsAre(2.0, 3.0));
    EXPECT_THAT(values_in(table_of(text, "input=2[mV],output=3[nm]"), "input", "V"),
                ElementsAre(0.001, 0.002));
}

TEST(TextTable, Mistakes_AreOneLineWithPlaceAndReason) {
    struct Mistake {
        std::string text, columns, message;
    };
    const std::array mistakes{
        Mistake{"", "input=1,output=2", "is empty"},
        Mistake{"\n\n", "input=1,output=2", "there is no row"},
        Mistake{"a,b\n", "input=1,output=2", "there is no row below the titles"},
        Mistake{"1,2\n3\n", "input=1,output=2", "table.txt:2: has 1 fields; the first line has 2"},
        Mistake{"1,2\n3,4", "input=1,output=2", "table.txt:2: the last line does not end"},
        Mistake{"1,2\n3,nan\n", "input=1,output=2", "table.txt:2: column 2: 'nan': must be finite"},
        Mistake{"1,2\n3,x\n", "input=1,output=2", "table.txt:2: column 2: 'x': must be a number"},
        Mistake{"1,2\n", "input=1,output=3", "output=3: no such column; allowed: 1 to 2"},
        Mistake{"a,b\n1,2\n", "input=c,output=2", "input=c: no such column; allowed: 1 to 2, a, b"},
    };
    for (const Mistake& mistake : mistakes) {
        SCOPED_TRACE(mistake.message);
        const std::string message = message_of([&] { table_of(mistake.text, mistake.columns); });
        EXPECT_THAT(message, HasSubstr(mistake.message));
        EXPECT_EQ(message.find('\n'), std::string::npos);
    }
}

TEST(TextTable, WrongChoices_SayWhatIsAllowed) {
    struct Mistake {
        const char *columns, *message;
    };
    for (const Mistake& mistake :
         {Mistake{"", "input is missing"}, Mistake{"input=1", "output is missing"},
          Mistake{"input", "'input' is not ROLE=COLUMN"}, Mistake{"force=1,output=2", "'force' is no role"},
          Mistake{"input=1,input=2", "input is given twice"},
          Mistake{"input=,output=2", "input has no column"}})
        EXPECT_THAT(message_of([&] { parse_columns(mistake.columns, roles, 2); }),
                    ::testing::AllOf(HasSubstr(mistake.message), HasSubstr("roles input, output, time")));
}

TEST(TextTable, UnitOfAnotherQuantity_IsRefused) {
    const TextTable table = table_of("1,2\n", "input=1[mm],output=2[furlong]");
    EXPECT_THAT(message_of([&] { values_in(table, "input", "V"); }),
                HasSubstr("input: unit 'mm': allowed: V, mV"));
    EXPECT_THAT(message_of([&] { values_in(table, "output", "mm"); }),
                HasSubstr("output: unit 'furlong': allowed: mm, um"));
}

TEST(TableTimes, RateOrColumn_GiveSeconds) {
    IdentifyInput input{{}, {}, table_of("1,2,5\n1,2,7\n", "input=1,output=2"), 200.0};
    EXPECT_THAT(table_times_s(input), ElementsAre(0.0, 0.005));
    input.table = table_of("1,2,5\n1,2,7\n", "input=1,output=2,time=3[ms]");
    EXPECT_THAT(table_times_s(input), ElementsAre(0.005, 0.007));
}

TEST(TableTimes, Backwards_IsRefused) {
    const IdentifyInput input{{}, {}, table_of("1,2,5\n1,2,5\n", "input=1,output=2,time=3"), 0.0};
    EXPECT_THAT(message_of([&] { table_times_s(input); }),
                HasSubstr("row 2: time: 5: must be after the row before, 5"));
}

TEST(TableAsMacroRecording, UnequalSpacing_IsRefused) {
    const IdentifyInput input{
        {}, {}, table_of("1,2,0\n1,2,1\n1,2,2.2\n1,2,3\n", "input=1,output=2,time=3"), 0.0};
    EXPECT_THAT(message_of([&] { table_as_macro_recording(input); }),
                HasSubstr("row 3: time: 2.2: rows must be equally spaced"));
}

}  // namespace
}  // namespace fidservo
